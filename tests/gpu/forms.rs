//! Pictures of single forms: the mesh in the colours of its population, which turns and casts a shadow.

use crate::support::{FORMAT, gpu};
use tellus::life::Model;
use tellus::planet::{Population, life::ReadyPopulation};
use tellus::render::{FormCamera, FormMesh, FormTarget, FormView, read_texture};

const SIZE_PX: [u32; 2] = [120, 120];
const BEHIND: [f32; 3] = [0.0, 0.0, 1.0];

fn draw(population: &Population, turn_rad: f64) -> Vec<[u8; 4]> {
    let gpu = gpu();
    let view = FormView::new(&gpu.device, &gpu.queue, FORMAT).unwrap();
    let target = FormTarget::new(&gpu.device, SIZE_PX, FORMAT);
    let mesh = FormMesh::new(&gpu.device, &Model::nearest(population, 0));
    let camera = FormCamera { turn_rad, raised_rad: 0.2, extent: [1.4, 1.4], middle: [0.0, 0.5] };
    view.draw(&target, &mesh, population, &camera, BEHIND);
    let bytes = read_texture(&gpu.device, &gpu.queue, target.view().texture()).unwrap();
    bytes.chunks(4).map(|pixel| [pixel[0], pixel[1], pixel[2], pixel[3]]).collect()
}

/// Share of pixels above the middle of the form that are not what is behind it, and their mean red over mean green.
fn upper(picture: &[[u8; 4]]) -> (f64, f64) {
    let upper = &picture[..picture.len() / 2];
    let seen: Vec<&[u8; 4]> = upper.iter().filter(|pixel| pixel[2] < 250).collect();
    let sum = |channel: usize| seen.iter().map(|pixel| f64::from(pixel[channel])).sum::<f64>();
    (seen.len() as f64 / upper.len() as f64, sum(0) / sum(1).max(1.0))
}

#[test]
fn a_form_is_seen_in_the_colours_of_its_population_and_another_side_of_it_when_it_turns() {
    let green = ReadyPopulation::named("Broadleaf tree").unwrap();
    let (front, side) = (draw(&green, 0.0), draw(&green, 1.2));
    let red = Population { leaf_color: [0.5, 0.02, 0.02], ..green.clone() };
    let ((share, of_green), (same_share, of_red)) = (upper(&front), upper(&draw(&red, 0.0)));
    assert!(share > 0.1 && share < 0.9 && (share - same_share).abs() < 0.01, "{share} {same_share}");
    assert!(of_green < 1.0 && of_red > 2.0, "{of_green} {of_red}");
    let other = front.iter().zip(&side).filter(|(a, b)| a != b).count() as f64 / front.len() as f64;
    assert!(other > 0.1, "{other}");
    assert!(draw(&green, 0.0) == front, "the same again");
}

#[test]
fn every_ready_population_has_a_picture_on_a_floor_with_its_shadow() {
    for ready in tellus::planet::life::READY_POPULATIONS {
        let picture = draw(&ready.population(), 0.5);
        let (share, _) = upper(&picture);
        // A cushion may be all of its picture, a dead tree a few boughs.
        assert!(share > 0.005, "{}: {share}", ready.name);
        let floor = &picture[picture.len() * 7 / 8..];
        let seen = floor.iter().filter(|pixel| pixel[2] < 250).count();
        assert!(seen > 20, "{}: {seen} pixels of the floor", ready.name);
    }
}
