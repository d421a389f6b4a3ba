// Lights up the places whose cells of the biome table are marked in the editor.
#include "border.wgsl"

// `light` at a place of the table, lit up if its cell is marked. `white`: what counts as bright in this picture.
fn lit_up(light: vec3f, place: vec2f, white: vec3f) -> vec3f {
    if body.marked == 0u { return light; }
    let cells = vec2f(textureDimensions(biome_ids));
    let marked = textureLoad(biome_ids, vec2i(place * cells), 0).g;
    return mix(light, vec3f(1.0, 0.62, 0.05) * white, marked * 0.72);
}
