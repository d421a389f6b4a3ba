// Highlights the ground of those cells of the biome table that are marked in the editor.
#include "border.wgsl"

// Highlights `light` if the cell at `location` in the biome table (0 to 1) is marked. `white`: bright level of this
// picture.
fn highlighted(light: vec3f, location: vec2f, white: vec3f) -> vec3f {
    if body.marked == 0u { return light; }
    let cells = vec2f(textureDimensions(biome_ids));
    let marked = textureLoad(biome_ids, vec2i(location * cells), 0).g;
    return mix(light, vec3f(1.0, 0.62, 0.05) * white, marked * 0.72);
}
