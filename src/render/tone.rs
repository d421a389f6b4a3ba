//! Tone curves from radiance to display values. `shaders/tone.wgsl` has the same curves for the GPU.

use super::wgsl::Constant;
use glam::DMat3;

/// A tone curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tone {
    /// Like film: highlights desaturate, hues keep their order (the primaries of AgX by Troy Sobotka, 2022, with a
    /// steeper curve).
    #[default]
    AgX,
    /// Keeps colours unchanged up to the highlights (Khronos PBR Neutral Tone Mapper, 2024).
    Neutral,
    /// No curve: values above white are clipped to white.
    Plain,
}

/// From linear Rec. 709 to the working space of AgX, and back; row by row.
const AGX_IN: [[f64; 3]; 3] = [
    [0.842479062253094, 0.0784335999999992, 0.0792237451477643],
    [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
    [0.0423756549057051, 0.0784336, 0.879142973793104],
];
const AGX_OUT: [[f64; 3]; 3] = [
    [1.19687900512017, -0.0980208811401368, -0.0990297440797205],
    [-0.0528968517574562, 1.15190312990417, -0.0989611768448433],
    [-0.0529716355144438, -0.0980434501171241, 1.15107367264116],
];
/// The curve of AgX over stops: radiance and display code of its pivot, slope there in codes per stop, exponents of the
/// bends towards black and white. Steeper than the original curve, with
/// white two stops above white ground: pictures of planets have few highlights, and need white clouds and dark seas.
const AGX_PIVOT: f64 = 0.2;
const AGX_PIVOT_CODE: f64 = 0.5;
const AGX_SLOPE: f64 = 0.26;
const AGX_TOE: f64 = 1.5;
const AGX_SHOULDER: f64 = 6.0;
/// Stops below the pivot whose value is black: the toe never reaches zero.
const AGX_BLACK_EV: f64 = 25.0;
/// Where highlights are beyond white the bends are gentler, and both change together: the exponents far beyond, and how
/// fast they come near them, per stop. With them highlights four stops over white keep nine tenths of the codes' range.
const AGX_LONG_TOE: f64 = 1.1;
const AGX_LONG_SHOULDER: f64 = 1.6;
const AGX_GENTLER: f64 = 1.5;
/// Share of the ratios between the channels that the brightest highlights keep there.
const AGX_KEPT: f64 = 0.5;
/// Factor on the difference from grey.
const AGX_SATURATION: f64 = 0.92;
/// Luminance at which half of the fill is left: [`super::Metered::fill_ev`].
const FILL_HALF: f64 = 0.05;
/// The constants of the curves with their names in `tone.wgsl`.
pub(super) fn constants() -> [(&'static str, Box<dyn Constant>); 14] {
    let matrix = |rows: &[[f64; 3]; 3]| Box::new(DMat3::from_cols_array_2d(rows).transpose());
    [
        ("AGX_IN", matrix(&AGX_IN)),
        ("AGX_OUT", matrix(&AGX_OUT)),
        ("AGX_PIVOT", Box::new(AGX_PIVOT)),
        ("AGX_PIVOT_CODE", Box::new(AGX_PIVOT_CODE)),
        ("AGX_SLOPE", Box::new(AGX_SLOPE)),
        ("AGX_TOE", Box::new(AGX_TOE)),
        ("AGX_SHOULDER", Box::new(AGX_SHOULDER)),
        ("AGX_BLACK_EV", Box::new(AGX_BLACK_EV)),
        ("AGX_LONG_TOE", Box::new(AGX_LONG_TOE)),
        ("AGX_LONG_SHOULDER", Box::new(AGX_LONG_SHOULDER)),
        ("AGX_GENTLER", Box::new(AGX_GENTLER)),
        ("AGX_KEPT", Box::new(AGX_KEPT)),
        ("FILL_HALF", Box::new(FILL_HALF)),
        ("AGX_SATURATION", Box::new(AGX_SATURATION)),
    ]
}

/// Weights of the Rec. 709 primaries in luminance.
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

impl Tone {
    /// All curves.
    pub const ALL: [Tone; 3] = [Tone::AgX, Tone::Neutral, Tone::Plain];

    /// Name for the user interface.
    pub fn label(self) -> &'static str {
        match self {
            Tone::AgX => "AgX",
            Tone::Neutral => "Neutral",
            Tone::Plain => "Plain",
        }
    }

    /// Display value of a radiance (1: white ground at noon), linear, 0 to 1: the reference for the shader.
    /// `beyond_ev`: stops by which highlights exceed white ([`super::Metered`]).
    pub fn shown(self, radiance: [f64; 3], beyond_ev: f64) -> [f64; 3] {
        match self {
            Tone::AgX => agx(radiance, beyond_ev),
            Tone::Neutral => neutral(radiance),
            Tone::Plain => radiance.map(|c| c.clamp(0.0, 1.0)),
        }
    }
}

fn times(matrix: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// Curve from 0 with slope 1 to 1 at infinity; the greater the power, the sharper the bend.
fn bend(x: f64, power: f64) -> f64 {
    x / libm::pow(1.0 + libm::pow(x, power), 1.0 / power)
}

fn agx(radiance: [f64; 3], beyond_ev: f64) -> [f64; 3] {
    let gentle = 1.0 - libm::exp(-AGX_GENTLER * beyond_ev);
    let toe = AGX_TOE + (AGX_LONG_TOE - AGX_TOE) * gentle;
    let shoulder = AGX_SHOULDER + (AGX_LONG_SHOULDER - AGX_SHOULDER) * gentle;
    let black = AGX_PIVOT_CODE * (1.0 - bend(AGX_BLACK_EV * AGX_SLOPE / AGX_PIVOT_CODE, toe));
    let mixed = times(&AGX_IN, radiance.map(|c| c.max(0.0)));
    let curved = mixed.map(|c| {
        let rise = AGX_SLOPE * libm::log2(c.max(1e-10) / AGX_PIVOT);
        let dark = AGX_PIVOT_CODE * (1.0 - bend((-rise).max(0.0) / AGX_PIVOT_CODE, toe));
        let light = (1.0 - AGX_PIVOT_CODE) * bend(rise.max(0.0) / (1.0 - AGX_PIVOT_CODE), shoulder);
        (dark + light - black).max(0.0)
    });
    let [peak, highest] = [mixed, curved].map(|of| of.into_iter().fold(0.0, f64::max));
    let kept = AGX_KEPT * gentle * ((highest - AGX_PIVOT_CODE) / (1.0 - AGX_PIVOT_CODE)).clamp(0.0, 1.0);
    let film = [0, 1, 2].map(|k| {
        let ratio = libm::pow(mixed[k] / peak.max(1e-10), 1.0 / 2.2);
        curved[k] + (highest * ratio - curved[k]) * kept
    });
    let grey: f64 = (0..3).map(|k| LUMINANCE[k] * film[k]).sum();
    times(&AGX_OUT, film.map(|c| grey + AGX_SATURATION * (c - grey))).map(|c| libm::pow(c.clamp(0.0, 1.0), 2.2))
}

fn neutral(radiance: [f64; 3]) -> [f64; 3] {
    const KNEE: f64 = 0.76;
    const PALING: f64 = 0.15;
    let light = radiance.map(|c| c.max(0.0));
    let least = light.into_iter().fold(f64::MAX, f64::min);
    let offset = if least < 0.08 { least - 6.25 * least * least } else { 0.04 };
    let raised = light.map(|c| c - offset);
    let peak = raised.into_iter().fold(0.0, f64::max);
    if peak < KNEE {
        return raised;
    }
    let shrunk = 1.0 - (1.0 - KNEE) * (1.0 - KNEE) / (peak + 1.0 - 2.0 * KNEE);
    let kept = 1.0 / (PALING * (peak - shrunk) + 1.0);
    raised.map(|c| shrunk + (c * shrunk / peak - shrunk) * kept)
}

/// Encodes a linear value as sRGB (IEC 61966-2-1), from 0 to 1; what lies beyond is cut off.
pub(crate) fn srgb_from_linear(value: f64) -> f64 {
    let value = value.clamp(0.0, 1.0);
    if value <= 0.003_130_8 { value * 12.92 } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_keep_grey_grey_and_never_turn_back() {
        for (tone, beyond_ev) in Tone::ALL.into_iter().flat_map(|tone| [(tone, 0.0), (tone, 0.4), (tone, 5.0)]) {
            let shown = |stop: i32| tone.shown([libm::exp2(f64::from(stop) * 0.1); 3], beyond_ev);
            let mut last = -1.0;
            for stop in -90..60 {
                let [r, g, b] = shown(stop);
                assert!((r - g).abs() < 2e-3 && (g - b).abs() < 2e-3, "{tone:?} {r} {g} {b}");
                assert!(g >= last - 1e-9 && (0.0..=1.0).contains(&g), "{tone:?} {stop}: {g} after {last}");
                last = g;
            }
            assert!(tone.shown([0.0; 3], beyond_ev).iter().all(|c| *c < 1e-3));
            assert!(shown(200)[1] > 0.92, "{tone:?} {last}");
        }
        // Highlights beyond white keep steps between them, and dark ground before them is brighter.
        let [sharp, gentle] = [0.0, 4.0].map(|beyond_ev| {
            [-5, 2, 4]
                .map(|ev| libm::pow(Tone::AgX.shown([libm::exp2(f64::from(ev)); 3], beyond_ev)[1], 1.0 / 2.2) * 255.0)
        });
        assert!(gentle[2] < 247.0 && gentle[2] > gentle[1] + 6.0 && sharp[2] < sharp[1] + 2.0, "{sharp:?} {gentle:?}");
        assert!(gentle[0] > sharp[0] + 8.0, "{sharp:?} {gentle:?}");
        // Published value: Neutral only subtracts the 4% that a surface reflects at its interface.
        assert!((Tone::Neutral.shown([0.5, 0.3, 0.2], 0.0)[0] - 0.46).abs() < 1e-12);
        // AgX maps its pivot to half of the display range, sunlit white to nearly white, and the sea's radiance to a
        // dark value.
        let code = |radiance: f64| libm::pow(Tone::AgX.shown([radiance; 3], 0.0)[1], 1.0 / 2.2) * 255.0;
        assert!((code(AGX_PIVOT) - 126.0).abs() < 1.0, "{}", code(AGX_PIVOT));
        assert!(code(0.75) > 235.0 && code(0.05) < 50.0, "{} {}", code(0.75), code(0.05));
        for (i, row) in AGX_IN.iter().enumerate() {
            let back = times(&AGX_OUT, [0, 1, 2].map(|k| AGX_IN[k][i]));
            for (k, c) in back.iter().enumerate() {
                assert!((c - f64::from(u8::from(k == i))).abs() < 1e-3, "{row:?} {back:?}");
            }
        }
    }
}
