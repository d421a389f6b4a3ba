//! Texture sets for tests: pictures in PNG, made from functions of the pixel.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used)]

/// A picture in PNG with 8 bits.
pub fn png([width, height]: [u32; 2], pixel: impl Fn(u32, u32) -> [u8; 3]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).flat_map(|(x, y)| pixel(x, y));
    encoder.write_header().unwrap().write_image_data(&pixels.collect::<Vec<u8>>()).unwrap();
    bytes
}

/// Bright and dark stripes across the rows, each of 16 of 512 pixels.
pub fn stripes() -> Vec<u8> {
    png([512; 2], |x, _| if (x / 16).is_multiple_of(2) { [230, 220, 200] } else { [60, 50, 40] })
}

/// One even grey.
pub fn even(grey: u8) -> Vec<u8> {
    png([16; 2], |_, _| [grey; 3])
}
