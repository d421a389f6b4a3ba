// What the surrounding ground leaves of the light at a point.
struct Visibility {
    // Visible share of the sun's disc, relative to the share over the horizon of the smooth planet
    star: f32,
    // Sky visibility
    sky: f32,
}
