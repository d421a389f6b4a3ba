//! Forms of what stands on the ground, and the parameters of each. `crate::life::form` makes their meshes, in files of
//! the same names. Lengths are shares of the height of an object.

use crate::planet::kinds::kinds;
use crate::planet::mesh::MeshFile;
use crate::planet::param::{Domain, Stage, Unit, choice, count, linear, log, params};

kinds! {
    /// The form of the objects.
    pub enum Form: "form", "Form", Stage::Life;
    /// A tree with branches and leaves.
    Tree(Tree) = "Tree",
    /// A conifer.
    Conifer(Conifer) = "Conifer",
    /// A palm.
    Palm(Palm) = "Palm",
    /// A tuft of blades: grass, reeds, ferns.
    Tuft(Tuft) = "Tuft",
    /// A cushion of moss or low shrub.
    Cushion(Cushion) = "Cushion",
    /// A cactus.
    Cactus(Cactus) = "Cactus",
    /// A group of mushrooms.
    Mushroom(Mushroom) = "Mushrooms",
    /// Fallen wood: trunks, boughs and twigs.
    Wood(Wood) = "Fallen wood",
    /// A stone.
    Stone(Stone) = "Stone",
    /// A cluster of crystals.
    Crystal(Crystal) = "Crystals",
    /// A group of stalks with spheres.
    Bulbs(Bulbs) = "Bulbs",
    /// A group of branching fans.
    Fans(Fans) = "Fans",
    /// A group of curling tendrils.
    Tendrils(Tendrils) = "Tendrils",
    /// A mesh of an artist, from a file.
    Mesh(FileMesh) = "Mesh of a file",
    /// An object that a game draws.
    Game(GameObject) = "Game's own",
}

impl Form {
    /// Variants of each form.
    pub const VARIANTS: u32 = 4;

    /// Size by which an object is seen from afar, as a multiple of its height: what lies is longer than it is high.
    pub(crate) fn seen_size(&self) -> f64 {
        if let Form::Wood(form) = self { form.length.sqrt() } else { 1.0 }
    }

    /// Whether the variants differ.
    pub(crate) fn has_variants(&self) -> bool {
        !matches!(self, Form::Game(_) | Form::Mesh(FileMesh { variants: false, .. }))
    }
}

choice! {
    /// Outline of a crown.
    pub enum Crown {
        /// A broad dome, as of an oak.
        Round = "Round",
        /// A pointed cone, wide at the foot.
        Cone = "Cone",
        /// A narrow column, as of a poplar.
        Column = "Column",
        /// A flat parasol, as of an acacia.
        Umbrella = "Umbrella",
        /// A dome with hanging twigs, as of a birch or willow.
        Weeping = "Weeping",
    }
}

params! {
    /// A tree: trunk, branches and a crown of leaves.
    pub struct Tree {
        /// Outline of the crown.
        crown: Crown = Crown::Round, "Crown", Unit::None, Domain::Choice, Stage::Life;
        /// Width of the crown, as a share of the height.
        crown_width: f64 = 0.8, "Crown width", Unit::None, linear(0.1, 2.0), Stage::Life;
        /// Part of the height that carries no branches.
        trunk: f64 = 0.25, "Bare trunk", Unit::None, linear(0.0, 0.8), Stage::Life;
        /// Width of the trunk above its roots, as a share of the height.
        trunk_width: f64 = 0.055, "Trunk width", Unit::None, linear(0.01, 0.2), Stage::Life;
        /// Amount of leaves: 0 is a dead tree, 1 a dense crown.
        leaves: f64 = 0.8, "Leaves", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Length of one cluster of leaves, as a share of the height.
        leaf_size: f64 = 0.06, "Leaf clusters", Unit::None, linear(0.02, 0.15), Stage::Life;
        /// Crookedness of the trunk and raggedness of the outline.
        irregular: f64 = 0.4, "Irregularity", Unit::None, linear(0.0, 1.0), Stage::Life;
    }
}

params! {
    /// A conifer: a straight trunk with whorls of branches that carry needles.
    pub struct Conifer {
        /// Width of the crown at its foot, as a share of the height.
        crown_width: f64 = 0.42, "Crown width", Unit::None, linear(0.1, 1.2), Stage::Life;
        /// Part of the height that carries no branches.
        trunk: f64 = 0.06, "Bare trunk", Unit::None, linear(0.0, 0.8), Stage::Life;
        /// Number of whorls of branches along the trunk.
        whorls: u32 = 17, "Whorls", Unit::None, count(4, 24), Stage::Life;
        /// Droop of the branches: negative rises, 1 hangs.
        droop: f64 = 0.45, "Droop", Unit::None, linear(-0.6, 1.0), Stage::Life;
        /// Pointedness of the crown: 1 is a sharp cone, 0 a rounded top.
        point: f64 = 0.9, "Pointedness", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Amount of needles on the branches.
        needles: f64 = 0.8, "Needles", Unit::None, linear(0.1, 1.0), Stage::Life;
        /// Spread of the branches' lengths, angles and gaps.
        irregular: f64 = 0.3, "Irregularity", Unit::None, linear(0.0, 1.0), Stage::Life;
    }
}

params! {
    /// A palm: a ringed trunk with a head of arched fronds.
    pub struct Palm {
        /// Number of fronds.
        fronds: u32 = 18, "Fronds", Unit::None, count(5, 40), Stage::Life;
        /// Length of a frond, as a share of the height.
        frond_length: f64 = 0.42, "Frond length", Unit::None, linear(0.1, 0.9), Stage::Life;
        /// Arch of the fronds: 0 stands stiff, 1 hangs over.
        arch: f64 = 0.6, "Arch", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Width of the trunk, as a share of the height.
        trunk_width: f64 = 0.04, "Trunk width", Unit::None, linear(0.01, 0.15), Stage::Life;
        /// Bend of the trunk: how far its head leans out, as a share of the height.
        bend: f64 = 0.2, "Bend", Unit::None, linear(0.0, 0.6), Stage::Life;
        /// Width of a frond with its leaflets, as a share of its length.
        leaflets: f64 = 0.35, "Leaflets", Unit::None, linear(0.1, 0.8), Stage::Life;
    }
}

params! {
    /// A tuft: blades or fronds that rise from one foot, as grass, reeds and ferns do.
    pub struct Tuft {
        /// Number of blades.
        blades: u32 = 22, "Blades", Unit::None, count(3, 40), Stage::Life;
        /// Width of a blade, as a share of the height.
        width: f64 = 0.05, "Blade width", Unit::None, linear(0.01, 0.3), Stage::Life;
        /// Spread of the blades: 0 stands upright, 1 lies far out.
        spread: f64 = 0.45, "Spread", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Arch of the blades: 0 is straight, 1 curls over.
        arch: f64 = 0.45, "Arch", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Share of the blades that carry a seed head.
        head: f64 = 0.0, "Seed heads", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Leaflets along both sides of the blades, as on a fern.
        leaflets: bool = false, "Leaflets", Unit::None, Domain::Flag, Stage::Life;
    }
}

params! {
    /// A cushion: a low mound of lumps, as moss, lichen and dwarf shrubs form.
    pub struct Cushion {
        /// Number of lumps.
        lumps: u32 = 9, "Lumps", Unit::None, count(1, 30), Stage::Life;
        /// Width of the mound, as a multiple of its height.
        width: f64 = 3.0, "Width", Unit::None, linear(0.8, 8.0), Stage::Life;
        /// Height of the lumps over the mound.
        lumpiness: f64 = 0.5, "Lumpiness", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Roughness of the surface.
        roughness: f64 = 0.3, "Roughness", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Amount of small leaves that stand out from the surface.
        leaves: f64 = 0.4, "Leaves", Unit::None, linear(0.0, 1.0), Stage::Life;
    }
}

params! {
    /// A cactus: a ribbed column, with arms or as a barrel.
    pub struct Cactus {
        /// Number of ribs.
        ribs: u32 = 14, "Ribs", Unit::None, count(5, 24), Stage::Life;
        /// Depth of the grooves between ribs, as a share of the radius.
        groove: f64 = 0.22, "Grooves", Unit::None, linear(0.0, 0.5), Stage::Life;
        /// Number of arms.
        arms: u32 = 3, "Arms", Unit::None, count(0, 8), Stage::Life;
        /// Width of the column, as a share of its height: above about 0.7 it is a barrel.
        girth: f64 = 0.13, "Girth", Unit::None, linear(0.05, 1.2), Stage::Life;
        /// Amount of spines on the ribs.
        spines: f64 = 0.5, "Spines", Unit::None, linear(0.0, 1.0), Stage::Life;
    }
}

params! {
    /// A group of mushrooms: stems with caps.
    pub struct Mushroom {
        /// Number of mushrooms in the group.
        cluster: u32 = 5, "Mushrooms", Unit::None, count(1, 9), Stage::Life;
        /// Width of the cap, as a share of the height.
        cap_width: f64 = 0.8, "Cap width", Unit::None, linear(0.2, 2.0), Stage::Life;
        /// Roundness of the cap: 0 is a flat plate, 1 a bell.
        cap_round: f64 = 0.55, "Cap roundness", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Width of the stem, as a share of the height.
        stem_width: f64 = 0.16, "Stem width", Unit::None, linear(0.03, 0.5), Stage::Life;
        /// Lean of the stems away from one another.
        lean: f64 = 0.35, "Lean", Unit::None, linear(0.0, 1.0), Stage::Life;
    }
}

params! {
    /// Fallen wood: a trunk, boughs or twigs that lie on the ground.
    pub struct Wood {
        /// Length of the longest piece, as a multiple of the height.
        length: f64 = 14.0, "Length", Unit::None, log(2.0, 30.0), Stage::Life;
        /// Number of pieces that lie together.
        pieces: u32 = 1, "Pieces", Unit::None, count(1, 9), Stage::Life;
        /// Amount and length of the branches: 0 is a bare log.
        branches: f64 = 0.3, "Branches", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Widening towards the roots at the butt.
        flare: f64 = 0.35, "Root flare", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Crookedness of the pieces.
        bend: f64 = 0.4, "Bend", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Moss, in the second colour: 0 is bare wood, 1 covers all but the lower side.
        moss: f64 = 0.4, "Moss", Unit::None, linear(0.0, 1.0), Stage::Life;
    }
}

params! {
    /// A stone: a block with cut faces, ledges and a rough skin.
    pub struct Stone {
        /// Roundness of the edges: 0 is freshly broken, 1 a pebble.
        roundness: f64 = 0.4, "Roundness", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Flatness: 0 is as high as wide, 1 a slab.
        flatness: f64 = 0.3, "Flatness", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Length over width: 1 is even.
        stretch: f64 = 1.3, "Stretch", Unit::None, linear(1.0, 3.0), Stage::Life;
        /// Number of flat faces cut into the block.
        cuts: u32 = 8, "Cut faces", Unit::None, count(0, 20), Stage::Life;
        /// Depth of the ledges between layers of rock.
        layers: f64 = 0.0, "Layers", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Roughness of the skin.
        roughness: f64 = 0.35, "Roughness", Unit::None, linear(0.0, 1.0), Stage::Life;
    }
}

params! {
    /// A cluster of crystals: six-sided prisms with pointed ends that lean outward.
    pub struct Crystal {
        /// Number of crystals.
        crystals: u32 = 12, "Crystals", Unit::None, count(1, 24), Stage::Life;
        /// Width of the largest crystal, as a share of the height.
        width: f64 = 0.2, "Width", Unit::None, linear(0.05, 0.6), Stage::Life;
        /// Lean of the outer crystals: 0 is upright, 1 almost flat.
        lean: f64 = 0.5, "Lean", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Distance of the outer crystals' feet from the middle, as a share of the height.
        spread: f64 = 0.2, "Spread", Unit::None, linear(0.0, 1.0), Stage::Life;
    }
}

params! {
    /// A group of bulb stalks: curved stalks that carry spheres of falling size.
    pub struct Bulbs {
        /// Number of stalks.
        stalks: u32 = 5, "Stalks", Unit::None, count(1, 9), Stage::Life;
        /// Number of spheres on each stalk.
        spheres: u32 = 7, "Spheres", Unit::None, count(1, 12), Stage::Life;
        /// Width of the largest sphere, as a share of the height.
        size: f64 = 0.2, "Sphere size", Unit::None, linear(0.05, 0.5), Stage::Life;
        /// Fall of the sizes along the stalk: 0 is even, 1 ends in beads.
        fall: f64 = 0.7, "Fall", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Curl of the stalks.
        curl: f64 = 0.5, "Curl", Unit::None, linear(0.0, 1.0), Stage::Life;
    }
}

params! {
    /// A group of fans: flat branching nets that stand on a short stem, as sea fans do.
    pub struct Fans {
        /// Number of fans.
        fans: u32 = 3, "Fans", Unit::None, count(1, 6), Stage::Life;
        /// Width of a fan, as a share of the height.
        width: f64 = 0.9, "Fan width", Unit::None, linear(0.2, 1.6), Stage::Life;
        /// Density of the net of branches.
        density: f64 = 0.6, "Density", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Thickness of the branches.
        thickness: f64 = 0.4, "Thickness", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Cupping of the fans around the middle.
        cup: f64 = 0.4, "Cupping", Unit::None, linear(0.0, 1.0), Stage::Life;
    }
}

params! {
    /// A group of tendrils: tapering spirals that twist upward and curl at the tips.
    pub struct Tendrils {
        /// Number of tendrils.
        tendrils: u32 = 7, "Tendrils", Unit::None, count(1, 12), Stage::Life;
        /// Width of a tendril at its foot, as a share of the height.
        width: f64 = 0.09, "Width", Unit::None, linear(0.02, 0.3), Stage::Life;
        /// Number of turns of the curl at the tip.
        curl: f64 = 1.4, "Curl", Unit::None, linear(0.0, 3.0), Stage::Life;
        /// Twist of the tendrils around one another, in turns.
        twist: f64 = 0.4, "Twist", Unit::None, linear(0.0, 2.0), Stage::Life;
        /// Spread of the tendrils: 0 stands upright, 1 leans far out.
        spread: f64 = 0.45, "Spread", Unit::None, linear(0.0, 1.0), Stage::Life;
    }
}

params! {
    /// A mesh of an artist: a glTF 2.0 file. Its foot is at the origin of the file, its height becomes that of the
    /// objects, and what lies below the origin is below the ground.
    pub struct FileMesh {
        /// The mesh: .glb, or .gltf with the files that it names beside it, of at most 200000 triangles. The path is
        /// relative to the preset's folder, or absolute. Without a file the objects are plain capsules.
        file: MeshFile = MeshFile::default(), "File", Unit::None, Domain::File { max_chars: 256 }, Stage::Life;
        /// Whether each node at the top of the scene is an object of its own, about its own place: the first four are
        /// the variants. Otherwise all nodes together are one object.
        variants: bool = false, "Nodes are variants", Unit::None, Domain::Flag, Stage::Life;
        /// Whether the objects have the colours of the file: those of materials, corners and pictures. Otherwise leaves
        /// have the leaf colour, and all else the colour of the population.
        own_colors: bool = true, "Colours of the file", Unit::None, Domain::Flag, Stage::Life;
    }
}

params! {
    /// An object that a game draws in its own way: it is placed, listed and hit as others are. Pictures show a capsule
    /// of its size.
    pub struct GameObject {
        /// Name by which the game knows what to draw.
        asset: String = String::new(), "Name in the game", Unit::None, Domain::Text { max_chars: 48 }, Stage::Life;
        /// Width of the object, as a share of the height.
        width: f64 = 0.3, "Width", Unit::None, log(0.02, 10.0), Stage::Life;
    }
}
