//! Blocks: the solid objects of a population in a cell.

use super::forms::SolidForm;
use super::shape::{Ball, Shape};
use crate::life::placement::PlacementScratch;
use crate::life::query::Instance;
use crate::life::soil::Soils;
use crate::sphere::NodeId;
use crate::terrain::{Scratch, Terrain};
use glam::{DMat3, DVec3};

/// An object that is hit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solid {
    pub(super) id: u64,
    pub(super) size_m: f64,
    variant: u8,
    foot_m: DVec3,
    form_from_planet: DMat3,
    /// Around all of it, in the planet frame.
    pub(super) ball_m: Ball,
}

/// The solid objects of a cell.
pub(super) struct Block {
    /// Number of the form, and the cell.
    pub(super) name: (usize, NodeId),
    pub(super) solids: Vec<Solid>,
    /// Around all of them.
    pub(super) ball_m: Ball,
    /// The question that needed it last.
    pub(super) asked: u64,
}

/// Memory for making blocks.
#[derive(Default)]
pub(super) struct BlockScratch {
    soils: Soils,
    placement: PlacementScratch,
    scratch: Scratch,
}

impl Solid {
    pub(super) fn new(instance: &Instance, shape: &Shape, planet_m: f64) -> Self {
        let (foot_m, planet_from_form) = (instance.foot_planet_m(planet_m), instance.planet_from_form());
        let Ball { middle, radius } = shape.ball;
        let size_m = instance.size_m;
        let ball_m = Ball { middle: foot_m + planet_from_form * (middle * size_m), radius: radius * size_m };
        let form_from_planet = planet_from_form.transpose();
        Self { id: instance.id, size_m, variant: instance.variant, foot_m, form_from_planet, ball_m }
    }

    pub(super) fn shape<'a>(&self, form: &'a SolidForm) -> &'a Shape {
        &form.shapes[usize::from(self.variant) % form.shapes.len()]
    }

    /// A position in the frame of the object, metres.
    pub(super) fn local_m(&self, position_m: DVec3) -> DVec3 {
        self.form_from_planet * (position_m - self.foot_m)
    }

    /// A direction in the frame of the object.
    pub(super) fn local(&self, dir: DVec3) -> DVec3 {
        self.form_from_planet * dir
    }

    /// A position in the planet frame, from that of the object.
    pub(super) fn planet_m(&self, local_m: DVec3) -> DVec3 {
        self.foot_m + self.planet(local_m)
    }

    /// A direction in the planet frame, from that of the object.
    pub(super) fn planet(&self, dir: DVec3) -> DVec3 {
        self.form_from_planet.transpose() * dir
    }
}

impl Block {
    /// Places the objects of a cell.
    pub(super) fn new(name: (usize, NodeId), form: &SolidForm, terrain: &Terrain, memory: &mut BlockScratch) -> Self {
        let BlockScratch { soils, placement: own, scratch } = memory;
        let (placement, cell) = (&form.placement, name.1);
        let node = placement.soil_node(cell);
        if let Some(node) = node {
            soils.add_one(terrain, node, scratch);
        }
        let planet_m = terrain.planet().radius_m();
        let mut instances = Vec::new();
        placement.place(terrain, &[cell], soils.get(node), own, &mut instances);
        let solid = |instance: &Instance| {
            let shape = &form.shapes[usize::from(instance.variant) % form.shapes.len()];
            (!shape.parts.is_empty()).then(|| Solid::new(instance, shape, planet_m))
        };
        let solids: Vec<Solid> = instances.iter().filter_map(solid).collect();
        let ball_m = Ball::around(solids.iter().map(|solid| solid.ball_m));
        Self { name, solids, ball_m, asked: 0 }
    }

    /// Memory that it takes.
    pub(super) fn bytes(&self) -> usize {
        size_of::<Self>() + self.solids.capacity() * size_of::<Solid>()
    }
}
