// LUT of light that air and ground have scattered: the first correction of the guess.
#include "screen.wgsl"
#include "correction.wgsl"

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> Texel { return corrected(pixel, false); }
