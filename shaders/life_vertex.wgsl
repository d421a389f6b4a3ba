// Corner of a form's mesh, as src/render/life/models.rs writes it.

struct Vertex {
    // Height 1, z up
    @location(0) position: vec3f,
    // Unit vector; logarithm of the factor on the light of the level of detail (src/life/form/cover.rs)
    @location(1) normal: vec4f,
    // Share of the second colour; share of the sky that it sees; how far the wind moves it; level of detail, a third
    // for each
    @location(2) look: vec4f,
    // Roots of the factors on the colours, half of what they are
    @location(3) tint: vec4f,
}

// Factor on the colours at a corner.
fn tint_of(in: Vertex) -> vec3f {
    let root = in.tint.rgb * (255.0 / 128.0);
    return root * root;
}
