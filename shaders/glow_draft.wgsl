// LUT of light that air scatters for a second time or more, by direction, while a slider is held. It takes moments
// alone, where glow.wgsl sums the light from all around.
#include "screen.wgsl"
#include "glow_moments.wgsl"

@fragment
fn fragment(@builtin(position) position: vec4f) -> Turns {
    set_lut_sun();
    let to = to_turns(position);
    var none: Lights;
    if all_is_dark(to.at.x, to.at.y) { return turns_of(none); }
    return turns_of(all_by_moments(to));
}
