//! The textures of a square as PNG files: colour, tangent-space normals, roughness. Texels lie in the coordinates of
//! the square; a value is the mean of four samples of its texel.

use super::patch::Patch;
use super::square::Square;
use super::surface::{BAND, Point, Surface};
use crate::bake::format::srgb_byte;
use crate::bake::progress::Progress;
use glam::DVec3;
use std::io::{self, Write};

/// Samples of a texel along each of its sides.
pub(super) const FINER: usize = 2;

/// PNG files.
pub(super) struct Textures {
    /// sRGB.
    pub(super) albedo: Vec<u8>,
    /// Along the tangent, the bitangent (upwards in the picture) and the normal of the finest level of detail, each
    /// from -1 to 1.
    pub(super) normal: Vec<u8>,
    /// Green: roughness; blue: metalness, which is 0; red: occlusion, which is 1 for none.
    pub(super) roughness: Vec<u8>,
}

impl Textures {
    /// Textures of `px` times `px` texels. They are incomplete if the bake has stopped.
    pub(super) fn new(
        square: &Square,
        px: u32,
        patch: &Patch,
        surface: &Surface<'_>,
        progress: &Progress<'_>,
    ) -> io::Result<Self> {
        let mut textures = Self { albedo: Vec::new(), normal: Vec::new(), roughness: Vec::new() };
        textures.encode(square, px, patch, surface, progress)?;
        Ok(textures)
    }

    fn encode(
        &mut self,
        square: &Square,
        px: u32,
        patch: &Patch,
        surface: &Surface<'_>,
        progress: &Progress<'_>,
    ) -> io::Result<()> {
        let side = px as usize;
        let place = |texel: usize| (texel as f64 + 0.5) / f64::from(px);
        // Four samples of a texel.
        let part = |sample: usize| (sample as f64 + 0.5) / f64::from(px * FINER as u32);
        let direction = |row: usize, column: usize| square.direction(part(column), part(row));
        let mut pictures = [
            picture(&mut self.albedo, px, true)?,
            picture(&mut self.normal, px, false)?,
            picture(&mut self.roughness, px, false)?,
        ];
        let [albedo, normal, roughness] = &mut pictures;
        let (mut albedo, mut normal, mut roughness) =
            (albedo.stream_writer()?, normal.stream_writer()?, roughness.stream_writer()?);
        let mut bytes = Vec::with_capacity(side * 3);
        let mut write = |out: &mut dyn Write, texels: &mut dyn Iterator<Item = [u8; 3]>| {
            bytes.clear();
            bytes.extend(texels.flatten());
            out.write_all(&bytes)
        };
        let spacing_rad = square.spacing_rad(px * FINER as u32);
        for first in (0..side).step_by(BAND / FINER) {
            let rows = first..(first + BAND / FINER).min(side);
            let fine = rows.start * FINER..rows.end * FINER;
            let samples = surface.band(fine, side * FINER, &direction, spacing_rad, progress);
            for (row, samples) in rows.zip(samples.chunks_exact(side * FINER * FINER)) {
                let points: Vec<Texel> = (0..side).map(|column| Texel::new(samples, column)).collect();
                write(&mut albedo, &mut points.iter().map(|point| point.color.map(srgb_byte)))?;
                write(&mut roughness, &mut points.iter().map(|point| [0xff, byte(point.roughness), 0]))?;
                let mut normals = points.iter().enumerate().map(|(column, point)| {
                    let (around, along) = patch.between(place(column), place(row));
                    let found = in_tangent_space(square.turned(point.normal_planet), around, along);
                    found.map(|component| byte(component * 0.5 + 0.5))
                });
                write(&mut normal, &mut normals)?;
            }
            if progress.is_stopped() {
                return Ok(());
            }
        }
        albedo.finish()?;
        normal.finish()?;
        roughness.finish()?;
        Ok(())
    }
}

/// The mean of the samples of a texel.
struct Texel {
    color: [f64; 3],
    roughness: f64,
    normal_planet: DVec3,
}

impl Texel {
    /// `samples`: [`FINER`] rows of them.
    fn new(samples: &[Point], column: usize) -> Self {
        let width = samples.len() / FINER;
        let of_texel = || samples.chunks_exact(width).flat_map(|row| &row[column * FINER..(column + 1) * FINER]);
        let mean = |value: &dyn Fn(&Point) -> f64| of_texel().map(value).sum::<f64>() / (FINER * FINER) as f64;
        Self {
            color: std::array::from_fn(|k| mean(&|point| point.color[k])),
            roughness: mean(&|point| point.roughness),
            normal_planet: of_texel().map(|point| point.normal_planet).sum::<DVec3>().normalize_or(DVec3::Z),
        }
    }
}

/// A normal along the tangent, the bitangent and the normal of a vertex (glTF 2.0, 3.9.3).
fn in_tangent_space(normal: DVec3, vertex_normal: DVec3, vertex_tangent: DVec3) -> [f64; 3] {
    let up = vertex_normal.normalize();
    let right = (vertex_tangent - up * up.dot(vertex_tangent)).normalize();
    [normal.dot(right), normal.dot(up.cross(right)), normal.dot(up)]
}

/// A share as a whole number of 8 bits.
fn byte(share: f64) -> u8 {
    (share * 255.0).round() as u8
}

/// Begins a picture of three channels of 8 bits.
fn picture(file: &mut Vec<u8>, px: u32, is_srgb: bool) -> io::Result<png::Writer<&mut Vec<u8>>> {
    let mut encoder = png::Encoder::new(file, px, px);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    if is_srgb {
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    }
    Ok(encoder.write_header()?)
}
