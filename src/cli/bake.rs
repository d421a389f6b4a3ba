//! `tellus bake`: maps of a planet in files.

use super::work::{WorkArgs, in_words, told};
use super::{Failure, area, args, load_as_source, maps, outputs, tell};
use crate::bake::{
    Bake, Detail, Format, Landscape, MAX_SIZE, Map, MapPlan, Outcome, Projection, Quadtree, Region, Shard,
};
use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use std::path::PathBuf;
use std::sync::Arc;

/// Bake maps of a planet: heights, normals, climate, biomes, water, clouds
#[derive(clap::Args)]
#[command(
    after_help = "The same command goes on where it was interrupted, and does nothing once all is done. Strips of \
    the maps are kept in the folder until all are there; damaged ones are made anew. With --shard several processes or \
    machines each make a part of them; the command without --shard then joins them. Copy the folders of machines \
    with disks of their own together first."
)]
pub(super) struct Args {
    /// The preset
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    /// The folder for the maps; it is made if there is none. A map X.png has X.json beside it: what its numbers mean
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// The maps
    #[arg(
        long,
        value_name = "MAP",
        value_delimiter = ',',
        default_value = "height",
        value_parser = PossibleValuesParser::new(Map::ALL.map(Map::name)).try_map(|name| Map::named(&name).ok_or(name))
    )]
    what: Vec<Map>,
    /// equirect: the whole globe in one picture. cube: six faces of a cube texture. region: a square about --lat and
    /// --lon, azimuthal equidistant. landscape: the same square in --tiles x --tiles tiles that share the vertices of
    /// their borders, as Unreal imports them. quadtree: the globe as tiles of all levels up to --levels, with aprons
    #[arg(
        long = "as",
        value_name = "PROJECTION",
        default_value = "equirect",
        value_parser = ["equirect", "cube", "region", "landscape", "quadtree"]
    )]
    projection: String,
    /// Width in pixels of the map, of a face or of a tile [default: 2048; of a tile of a landscape 1009, of a quadtree
    /// 256]
    #[arg(long, value_name = "N", value_parser = |text: &str| args::whole(text, 2, MAX_SIZE))]
    size: Option<u32>,
    /// Tiles along each side of a landscape [default: 1]
    #[arg(long, value_name = "N", value_parser = |text: &str| args::whole(text, 1, MAX_SIZE))]
    tiles: Option<u32>,
    /// The finest level of a quadtree, which has 2^N tiles along each side of the six faces [default: 3]
    #[arg(long, value_name = "N", value_parser = |text: &str| args::whole(text, 0, Quadtree::MOST_LEVELS))]
    levels: Option<u8>,
    /// Pixels of the neighbours around each tile of a quadtree [default: 1]
    #[arg(long, value_name = "N", value_parser = |text: &str| args::whole(text, 0, MAX_SIZE / 8))]
    apron: Option<u32>,
    /// png8, png16, tiff16 and r16 are whole numbers that run linearly between min and max of the JSON; exr and tiff
    /// are floats of 32 bits, exr16 of 16; tiff is georeferenced; r16 has no header; ktx2 is a texture with mip levels
    #[arg(
        long,
        value_name = "FORMAT",
        default_value = "png16",
        value_parser = PossibleValuesParser::new(Format::ALL.map(Format::name)).try_map(|name| Format::named(&name).ok_or(name))
    )]
    format: Format,
    #[arg(
        long,
        help = "Latitude of the centre of a region in degrees, north positive",
        value_name = "DEG",
        value_parser = args::latitude,
        required_if_eq_any([("projection", "region"), ("projection", "landscape")])
    )]
    lat: Option<f64>,
    #[arg(
        long,
        help = "Longitude of the centre of a region in degrees, east positive",
        value_name = "DEG",
        value_parser = args::longitude,
        required_if_eq_any([("projection", "region"), ("projection", "landscape")])
    )]
    lon: Option<f64>,
    /// Length of a side of a region
    #[arg(
        long,
        value_name = "KILOMETRES",
        value_parser = args::region,
        required_if_eq_any([("projection", "region"), ("projection", "landscape")])
    )]
    km: Option<f64>,
    /// pixel: without valleys and rivers of a structure that are too narrow for the pixels, as the planet is drawn from
    /// afar. all: what `tellus sample` answers; where pixels are farther apart than valleys it takes far longer,
    /// which is said before
    #[arg(
        long,
        value_name = "DETAIL",
        default_value = "pixel",
        value_parser = area::detail()
    )]
    detail: Detail,
    /// Heights in metres that whole numbers run between [default: the lowest and the highest of the map]
    #[arg(long, value_name = "MIN,MAX", value_parser = args::heights)]
    range: Option<[f64; 2]>,
    /// Time in seconds, for clouds
    #[arg(long, value_name = "SECONDS", default_value = "0", value_parser = args::seconds)]
    time: f64,
    /// Make only the part I of N of the strips, such as 2/8
    #[arg(long, value_name = "I/N", value_parser = args::shard)]
    shard: Option<(u32, u32)>,
    #[command(flatten)]
    work: WorkArgs,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    args.work.begin()?;
    let (planet, sources) = load_as_source(&args.file)?;
    let projection = projection(args)?;
    let usual = match projection {
        Projection::Landscape(_) => Landscape::SIZE,
        Projection::Quadtree(_) => Quadtree::SIZE,
        _ => SIZE,
    };
    let size = args.size.unwrap_or(usual);
    let plan = MapPlan { maps: &args.what, projection, size, format: args.format };
    outputs::check_files_in(&args.output, &sources, &plan.files(&planet, &args.output)?)?;
    let parts = u64::from(args.shard.map_or(1, |(_, count)| count));
    outputs::check_disk(&args.output, plan.least_bytes(&planet)? / parts, Some("strip"))?;
    let terrain = Arc::new(maps::terrain(planet)?);
    let mut bake = Bake::new(terrain, args.what.clone(), projection, size, args.format);
    bake.detail = args.detail;
    bake.time_secs = args.time;
    bake.heights_m = args.range;
    bake.shard = args.shard.map(|(number, count)| Shard { number, count });
    if let Some(expected) = bake.expected(&args.output).filter(|expected| expected.secs > WORTH_A_WORD_SECS) {
        let (pixels, time) = (expected.pixels, in_words(expected.secs));
        let (threads, megabytes) = (rayon::current_num_threads(), expected.strip_bytes.div_ceil(1_000_000));
        tell(&format!(
            "note: all detail of {pixels} pixels takes about {time} on {threads} threads, and {megabytes} MB of disk \
             for strips; --detail pixel leaves out what is narrower than pixels"
        ));
    }
    match bake.run(&args.output, &told("baked")).map_err(|error| error.to_string())? {
        Outcome::Kept(_) => tell("the maps are there already, whole, and made by this bake: nothing was done"),
        Outcome::Shard { missing: 0 } => tell("all strips are there; the same command without --shard joins them"),
        Outcome::Shard { missing } => {
            tell(&format!("this shard is done; {missing} strips of others are not there yet"));
        }
        Outcome::Done(_) | Outcome::Stopped => {}
    }
    Ok(())
}

/// Time from which a bake tells what it will take.
const WORTH_A_WORD_SECS: f64 = 10.0;

/// Width of a picture, unless another one is asked for.
const SIZE: u32 = 2048;

fn projection(args: &Args) -> Result<Projection, Failure> {
    let kind = args.projection.as_str();
    let region = match (args.lat, args.lon, args.km) {
        (Some(lat_deg), Some(lon_deg), Some(side_km)) => Some(Region { lat_deg, lon_deg, side_km }),
        _ => None,
    };
    let lies_somewhere = args.lat.is_some() || args.lon.is_some() || args.km.is_some();
    if lies_somewhere && !matches!(kind, "region" | "landscape") {
        return Err("--lat, --lon and --km are for --as region and --as landscape".to_owned().into());
    }
    if args.tiles.is_some() && kind != "landscape" {
        return Err("--tiles is for --as landscape".to_owned().into());
    }
    if (args.levels.is_some() || args.apron.is_some()) && kind != "quadtree" {
        return Err("--levels and --apron are for --as quadtree".to_owned().into());
    }
    Ok(match (kind, region) {
        ("region", Some(region)) => Projection::Region(region),
        ("landscape", Some(region)) => Projection::Landscape(Landscape { region, tiles: args.tiles.unwrap_or(1) }),
        ("quadtree", _) => {
            Projection::Quadtree(Quadtree { levels: args.levels.unwrap_or(3), apron: args.apron.unwrap_or(1) })
        }
        ("cube", _) => Projection::Cube,
        _ => Projection::Equirect,
    })
}
