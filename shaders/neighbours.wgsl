// Shade that objects of one population cast on one another, by the mean.

// Shade on an object as a share of the shade behind its neighbours: they reach up to it in part.
const NEIGHBOUR_SHADE: f32 = 0.8;

// Distance over height of a ray that is inclined by the arc cosine of `cosine` to the normal of the ground.
fn ray_tangent(cosine: f32) -> f32 {
    let c = max(cosine, 0.03);
    return sqrt(max(1.0 - c * c, 0.0)) / c;
}

// Share of the sun's light that neighbours leave to what is seen of an object. `area`: that of the neighbours from the
// side, for each area of ground. `cosine`: of the angle between sun and eye. Where the eye is near the line to the sun,
// it sees what the sun sees.
fn neighbours_leave(area: f32, sun_tangent: f32, cosine: f32) -> f32 {
    let shade = area * sun_tangent * NEIGHBOUR_SHADE * smoothstep(0.0, 0.6, 1.0 - cosine);
    return select((1.0 - exp(-shade)) / shade, 1.0, shade < 1e-3);
}
