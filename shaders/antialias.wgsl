// Antialiasing of edges. A pixel has one sample, so a slanted edge is drawn as a staircase. From each edge between two
// pixels, the search runs both ways along the edge to the steps (risers) that end it. The line between the middles of
// the two risers approximates the true edge and gives the share of the pixel beyond it. Method: morphological
// antialiasing (Reshetov, Morphological Antialiasing, 2009; Jimenez et al., SMAA: Enhanced Subpixel Morphological
// Antialiasing, 2012) in one pass after the tone curve, with one edge for each pixel (as in Lottes, FXAA, 2009).
#include "screen.wgsl"
#include "math.wgsl"

// rgb: display values, linear; a: perceived brightness
@group(1) @binding(0) var shown: texture_2d<f32>;

// Brightness steps at which an edge begins to count and counts in full. Weaker steps are texture of the ground.
const FAINT: f32 = 0.03;
const CLEAR: f32 = 0.09;
// Rise of brightness from one pixel before the edge to one pixel behind it, relative to the edge's own step: a full
// edge up to STEEP, none from SLOPING on (the gradient is smooth already).
const STEEP: f32 = 1.15;
const SLOPING: f32 = 1.6;
// An edge continues while at least this share of its step remains.
const KEPT: f32 = 0.5;
// The search covers 2 * REACH pixels each way: a limb seen from near is nearly level, so its risers are far apart.
const REACH: i32 = 48;

fn brightness(pixel: vec2i) -> f32 {
    return textureLoad(shown, clamp(pixel, vec2i(0), vec2i(textureDimensions(shown)) - 1), 0).a;
}

// Brightness of the four pixels around a pixel corner: upper left, upper right, lower left, lower right.
fn around(corner: vec2f) -> vec4f {
    return textureGather(3, shown, clamped, corner / vec2f(textureDimensions(shown))).wzxy;
}

// The riser that ends an edge on one side.
struct Riser {
    // Distance from the middle of the pixel, in pixels
    away: f32,
    // 1 if the colour beyond the edge continues in the pixel's own row behind the riser, 0 if not, or between
    inward: f32,
}

// Follows the edge that starts in the middle of one of a pixel's sides. `first`: brightness of the pixel and of the
// pixel across the edge.
fn follow(start: vec2f, along: vec2f, across: vec2f, first: vec2f) -> Riser {
    let contrast = first.y - first.x;
    // Distance to the border of the picture, which ends every edge.
    let room = dot(abs(along), select(start, vec2f(textureDimensions(shown)) - start, along > vec2f(0.0)));
    let pairs = min(2 * REACH, i32(room));
    var last = first.x + first.y;
    for (var i = 1; i <= pairs; i += 2) {
        let four = around(start + along * (f32(i) + 0.5));
        // Two pairs, each of the pixel in the row and the pixel across the edge.
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

// Share of a pixel beyond the line that falls from half a pixel at a riser to zero halfway to the other riser. `away`:
// distance to the riser; `length`: distance between the risers; both in pixels.
fn beyond(away: f32, length: f32) -> f32 {
    let begin = away - 0.5;
    let end = min(away + 0.5, 0.5 * length);
    return max(end - begin, 0.0) * (0.5 - 0.5 * (begin + end) / length);
}

// The neighbour that extends into a pixel beyond the edge between them, and the share of the pixel that it covers. `c`:
// brightness of the pixel.
struct Overlap {
    across: vec2f,
    share: f32,
}

fn overlap(at: vec2f, across: vec2f, c: f32) -> Overlap {
    let there = brightness(vec2i(at + across));
    var strength = smoothstep(FAINT, CLEAR, abs(there - c));
    if strength <= 0.0 { return Overlap(across, 0.0); }
    // A step that is part of a longer rise is smooth already.
    let rise = brightness(vec2i(at + 2.0 * across)) - brightness(vec2i(at - across));
    strength *= 1.0 - smoothstep(STEEP, SLOPING, rise / (there - c));
    let start = at + 0.5 * across;
    let along = abs(across.yx);
    let one = follow(start, along, across, vec2f(c, there));
    let other = follow(start, -along, across, vec2f(c, there));
    let length = one.away + other.away;
    let share = one.inward * beyond(one.away, length) + other.inward * beyond(other.away, length);
    // A dot, such as a star, is not a staircase.
    let dot = one.inward * other.inward * saturate1(2.0 - length);
    return Overlap(across, share * strength * (1.0 - dot));
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let here = textureLoad(shown, vec2i(position.xy), 0);
    let before = around(position.xy - 0.5);
    let after = around(position.xy + 0.5);
    // Steps of brightness to the left, up, right and down.
    let steps = abs(vec4f(before.zy, after.yz) - here.a);
    if max(max(steps.x, steps.y), max(steps.z, steps.w)) <= FAINT { return here; }
    // The stronger edge in each direction.
    let sideways = overlap(position.xy, vec2f(select(-1.0, 1.0, steps.z > steps.x), 0.0), here.a);
    let upright = overlap(position.xy, vec2f(0.0, select(-1.0, 1.0, steps.w > steps.y)), here.a);
    let across = select(sideways.across, upright.across, upright.share >= sideways.share);
    let share = max(sideways.share, upright.share);
    if share <= 0.0 { return here; }
    return mix(here, textureLoad(shown, vec2i(position.xy + across), 0), share);
}
