//! The camera of `tellus render` and `tellus film`: what a photographer sets.

use super::{Failure, args};
use crate::film::{FileKind, Shot};
use crate::lod::{Camera, Quality, View};
use crate::planet::Planet;
use crate::render::{DebugView, Lens, Metering, Photo, Post, Tone};
use crate::terrain::Terrain;
use clap::ValueEnum;
use clap::builder::PossibleValue;
use std::path::Path;
use std::sync::Arc;

/// Size, lens, exposure and quality.
#[derive(clap::Args)]
pub(super) struct CameraArgs {
    /// Width and height in pixels. Large pictures are drawn in tiles
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = args::size)]
    pub(super) size: [u32; 2],
    /// Vertical field of view in degrees
    #[arg(
        long,
        value_name = "DEG",
        default_value_t = Camera::DEFAULT_FOV_Y_RAD.to_degrees(),
        value_parser = args::field_of_view
    )]
    pub(super) fov: f64,
    /// Focal length in mm in front of a sensor 24 mm high, in place of --fov
    #[arg(long, value_name = "MM", conflicts_with = "fov", value_parser = args::focal_length)]
    pub(super) focal: Option<f64>,
    /// Diameter of the lens: what is not in focus is blurred. 0.01 is a camera's; 1000 makes a model of a continent.
    /// Needs --focus, and --samples of 4 or more
    #[arg(long, value_name = "METRES", requires = "focus", value_parser = args::length)]
    pub(super) aperture: Option<f64>,
    /// Distance along the view axis that is in focus
    #[arg(long, value_name = "METRES", requires = "aperture", value_parser = args::length)]
    pub(super) focus: Option<f64>,
    /// Samples along each side of a pixel, 1 to 16
    #[arg(long, value_name = "N", default_value = "1", value_parser = args::samples)]
    pub(super) samples: u32,
    /// Bits of each colour of a .png: 8 or 16
    #[arg(long, value_name = "BITS", value_parser = ["8", "16"])]
    pub(super) bits: Option<String>,
    /// Exposure in stops, 0 for a sunlit planet [default: metered from the picture]
    #[arg(long, value_name = "EV", value_parser = args::exposure)]
    pub(super) exposure: Option<f64>,
    /// Colour temperature in kelvins that is shown white: lower makes the picture bluer
    #[arg(long, value_name = "K", default_value_t = Post::DAYLIGHT_K, value_parser = args::white)]
    pub(super) white: f64,
    /// How much darker the corners are, 0 to 1
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = args::share)]
    pub(super) vignette: f64,
    /// Share of the light that the lens scatters, 0 to 1: the glow of the sun and of highlights
    #[arg(long, value_name = "SHARE", default_value_t = Post::CLEAN_LENS, value_parser = args::share)]
    pub(super) bloom: f64,
    /// Tone curve from radiance to the picture
    #[arg(long, value_enum, default_value_t = Tone::default())]
    pub(super) tone: Tone,
    /// Quality of the picture
    #[arg(long, value_enum, default_value_t = Quality::High)]
    pub(super) quality: Quality,
    /// Seconds for building the ground of each picture, which then stays as fine as it is [default: until it is done]
    #[arg(long, value_name = "SECONDS", value_parser = args::ground_seconds)]
    pub(super) ground_seconds: Option<f64>,
    /// Memory for the ground of each picture, coarser if more would be needed [default: what the quality takes]
    #[arg(long, value_name = "MIB", value_parser = args::ground_mib)]
    pub(super) ground_mib: Option<u32>,
    /// The shaded planet, or a debug view
    #[arg(long, value_enum, default_value_t = DebugView::default())]
    pub(super) view: DebugView,
    /// The population whose density --view density shows [default: the first]
    #[arg(long, value_name = "NAME")]
    pub(super) population: Option<String>,
}

impl CameraArgs {
    /// Vertical field of view.
    pub(super) fn fov_y_rad(&self) -> f64 {
        self.focal.map_or(self.fov.to_radians(), |focal_mm| 2.0 * (0.5 * SENSOR_MM / focal_mm).atan())
    }

    /// How the picture is developed.
    pub(super) fn post(&self) -> Post {
        Post {
            metering: if self.exposure.is_some() { Metering::Manual } else { Metering::Instant },
            exposure_ev: self.exposure.unwrap_or(0.0),
            tone: self.tone,
            white_k: self.white,
            vignette: self.vignette,
            bloom: self.bloom,
            ..Post::default()
        }
    }

    /// Samples and lens.
    pub(super) fn photo(&self) -> Photo {
        let lens = self.aperture.zip(self.focus).map(|(diameter_m, focus_m)| Lens { diameter_m, focus_m });
        Photo { samples: self.samples, lens, ..Photo::default() }
    }

    /// A photograph that this camera takes.
    pub(super) fn shot(&self, terrain: &Arc<Terrain>, camera: Camera, time_secs: f64) -> Shot {
        Shot {
            terrain: terrain.clone(),
            revision: terrain.revision().clone(),
            view: View { camera, size_px: self.size, quality: self.quality },
            time_secs,
            sun: None,
            debug_view: self.view,
            population: self.population_of(terrain.planet()).unwrap_or(0),
            post: self.post(),
            photo: self.photo(),
            system: None,
            focuses: false,
            ground_secs: self.ground_seconds,
            ground_bytes: self.ground_mib.map(|mib| (mib as usize) << 20),
        }
    }

    /// The kind of a file to write.
    pub(super) fn kind(&self, output: &Path) -> Result<FileKind, String> {
        FileKind::of(output, self.bits.as_deref().and_then(|bits| bits.parse().ok()))
    }

    /// Whether the planet has what the debug view shows.
    pub(super) fn check_view(&self, planet: &Planet, file: &Path) -> Result<(), Failure> {
        if self.view.needs_structure() && planet.structure.is_none() {
            let (file, view) = (file.display(), self.view.label());
            return Err(
                format!("{file}: the planet has no structure, so that there is no map of {view} to show").into()
            );
        }
        if self.population.is_some() && self.view != DebugView::Density {
            let told = "--population: this view shows no population; use it with --view density";
            return Err(told.to_owned().into());
        }
        if self.view == DebugView::Density && self.population_of(planet).is_none() {
            let file = file.display();
            if planet.life.is_empty() {
                return Err(format!("{file}: nothing stands on the planet, so that there is no density to show").into());
            }
            let names: Vec<&str> = planet.life.iter().map(|population| population.name.as_str()).collect();
            let asked = self.population.as_deref().unwrap_or_default();
            return Err(format!("{file}: there is no population `{asked}`; use one of {}", names.join(", ")).into());
        }
        Ok(())
    }

    /// Index of the population whose density is shown.
    fn population_of(&self, planet: &Planet) -> Option<usize> {
        let is_asked = |name: &str| self.population.as_ref().is_none_or(|asked| asked == name);
        planet.life.iter().position(|population| is_asked(&population.name))
    }
}

impl ValueEnum for Quality {
    fn value_variants<'a>() -> &'a [Self] {
        &Quality::ALL
    }
    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(match self {
            Quality::Low => "low",
            Quality::Medium => "medium",
            Quality::High => "high",
        }))
    }
}

impl ValueEnum for Tone {
    fn value_variants<'a>() -> &'a [Self] {
        &Tone::ALL
    }
    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(match self {
            Tone::AgX => "agx",
            Tone::Neutral => "neutral",
            Tone::Plain => "plain",
        }))
    }
}

impl ValueEnum for DebugView {
    fn value_variants<'a>() -> &'a [Self] {
        &DebugView::ALL
    }
    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(match self {
            DebugView::Shaded => "shaded",
            DebugView::Height => "height",
            DebugView::Normal => "normal",
            DebugView::Slope => "slope",
            DebugView::Biome => "biome",
            DebugView::Temperature => "temperature",
            DebugView::Moisture => "moisture",
            DebugView::Lod => "lod",
            DebugView::TileBorders => "tiles",
            DebugView::Error => "error",
            DebugView::Wireframe => "wireframe",
            DebugView::Coverage => "coverage",
            DebugView::Albedo => "albedo",
            DebugView::Plates => "plates",
            DebugView::Rain => "rain",
            DebugView::Rivers => "rivers",
            DebugView::Density => "density",
        }))
    }
}

/// Tells how much of a picture is drawn, if it takes long.
pub(super) fn told() -> impl FnMut(f64) -> bool {
    super::work::told("drawn")
}

/// Height of the sensor that focal lengths refer to: that of 35 mm film.
const SENSOR_MM: f64 = 24.0;
