// Smooth edges. A pixel has one sample, so an edge that runs aslant is a stair. Each stair's riser is looked for both ways along its
// contrast; the line from middle of riser to middle of riser is taken for the edge itself, and tells what share of the pixel lies beyond it.
// Method: morphological antialiasing (Reshetov, Morphological Antialiasing, 2009; Jimenez et al., SMAA: Enhanced Subpixel Morphological
// Antialiasing, 2012) in one pass after the curve, an edge to a pixel (as Lottes, FXAA, 2009).
#include "screen.wgsl"
#include "math.wgsl"

// rgb: what is shown, linear; a: how bright it looks
@group(1) @binding(0) var shown: texture_2d<f32>;

// Steps in brightness between which a pixel's edge begins to count, and counts in full: what is weaker is the ground's texture.
const FAINT: f32 = 0.03;
const CLEAR: f32 = 0.09;
// How much more than the step it may rise from a pixel before to a pixel behind it, for an edge and for none.
const STEEP: f32 = 1.15;
const SLOPING: f32 = 1.6;
// An edge goes on where this share of its step is left.
const KEPT: f32 = 0.5;
// Twice as many pixels each way are looked at: a limb seen from near is nearly level.
const REACH: i32 = 48;

fn brightness(pixel: vec2i) -> f32 {
    return textureLoad(shown, clamp(pixel, vec2i(0), vec2i(textureDimensions(shown)) - 1), 0).a;
}

// Brightness of the four pixels around a corner: upper left, upper right, lower left, lower right.
fn around(corner: vec2f) -> vec4f {
    return textureGather(3, shown, clamped, corner / vec2f(textureDimensions(shown))).wzxy;
}

// The riser that ends an edge on one side.
struct Riser {
    // From the middle of the pixel, pixels
    away: f32,
    // Whether it goes into the pixel's own row, so that what is beyond the edge goes on in it: 0 or 1, or between
    inward: f32,
}

// Follows the edge that starts in the middle of one of a pixel's sides. `first`: brightness of the pixel and of the one across.
fn follow(start: vec2f, along: vec2f, across: vec2f, first: vec2f) -> Riser {
    let contrast = first.y - first.x;
    // To the border of the picture, which ends every edge.
    let room = dot(abs(along), select(start, vec2f(textureDimensions(shown)) - start, along > vec2f(0.0)));
    let pairs = min(2 * REACH, i32(room));
    var last = first.x + first.y;
    for (var i = 1; i <= pairs; i += 2) {
        let four = around(start + along * (f32(i) + 0.5));
        // Two pairs, each the pixel in the row and the one across.
        let turned = select(four.xzyw, four, along.x != 0.0);
        let ordered = select(turned.zwxy, turned, across.x + across.y > 0.0);
        let found = select(ordered.yxwz, ordered, along.x + along.y > 0.0);
        let near = found.xz;
        let far = found.yw;
        if (near.y - near.x) / contrast < KEPT {
            return Riser(f32(i) - 0.5, saturate1((near.x + near.y - last) / contrast));
        }
        if (far.y - far.x) / contrast < KEPT {
            return Riser(f32(i) + 0.5, saturate1((far.x + far.y - near.x - near.y) / contrast));
        }
        last = far.x + far.y;
    }
    return Riser(f32(pairs) + 0.5, 0.0);
}

// Share of a pixel beyond the line that falls from half a pixel at a riser to nothing halfway to the next one.
fn beyond(away: f32, length: f32) -> f32 {
    let begin = away - 0.5;
    let end = min(away + 0.5, 0.5 * length);
    return max(end - begin, 0.0) * (0.5 - 0.5 * (begin + end) / length);
}

// Which neighbour of a pixel goes on in it beyond the edge between them, and in what share of it. `c`: the pixel's brightness.
struct Overlap {
    across: vec2f,
    share: f32,
}

fn overlap(at: vec2f, across: vec2f, c: f32) -> Overlap {
    let there = brightness(vec2i(at + across));
    var strength = smoothstep(FAINT, CLEAR, abs(there - c));
    if strength <= 0.0 { return Overlap(across, 0.0); }
    // What rises further on either side is smooth already.
    let rise = brightness(vec2i(at + 2.0 * across)) - brightness(vec2i(at - across));
    strength *= 1.0 - smoothstep(STEEP, SLOPING, rise / (there - c));
    let start = at + 0.5 * across;
    let along = abs(across.yx);
    let one = follow(start, along, across, vec2f(c, there));
    let other = follow(start, -along, across, vec2f(c, there));
    let length = one.away + other.away;
    let share = one.inward * beyond(one.away, length) + other.inward * beyond(other.away, length);
    // A dot, such as a star, is no stair.
    let dot = one.inward * other.inward * saturate1(2.0 - length);
    return Overlap(across, share * strength * (1.0 - dot));
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let here = textureLoad(shown, vec2i(position.xy), 0);
    let before = around(position.xy - 0.5);
    let after = around(position.xy + 0.5);
    // Steps to the left, up, right and down.
    let steps = abs(vec4f(before.zy, after.yz) - here.a);
    if max(max(steps.x, steps.y), max(steps.z, steps.w)) <= FAINT { return here; }
    // The stronger edge of either direction.
    let sideways = overlap(position.xy, vec2f(select(-1.0, 1.0, steps.z > steps.x), 0.0), here.a);
    let upright = overlap(position.xy, vec2f(0.0, select(-1.0, 1.0, steps.w > steps.y)), here.a);
    let across = select(sideways.across, upright.across, upright.share >= sideways.share);
    let share = max(sideways.share, upright.share);
    if share <= 0.0 { return here; }
    return mix(here, textureLoad(shown, vec2i(position.xy + across), 0), share);
}
