//! Shader sources: `#include`, validation with file and line, and hot reload during development.
//!
//! The files of `shaders/` are embedded in the program. Debug builds prefer the files on disk where they exist, and
//! `Watch` reports changes to them.

use super::{RenderError, shared};
use include_dir::{Dir, include_dir};
use std::borrow::Cow;
use std::path::PathBuf;
use std::time::{Duration, Instant, SystemTime};
use wgpu::naga;

/// The files of `shaders/` at build time.
static EMBEDDED: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/shaders");

/// Name of the include that `shared` generates; it is no file.
const SHARED: &str = "shared.wgsl";
/// Cube arrays hold the cloud maps. All adapters of WebGPU have them.
const CAPABILITIES: naga::valid::Capabilities = naga::valid::Capabilities::CUBE_ARRAY_TEXTURES;

/// The entry files, one for each pass. All other files are included by them.
pub fn entries() -> Vec<&'static str> {
    let is_entry = |text: &str| text.contains("\n@fragment") || text.contains("\n@compute");
    let files = EMBEDDED.files().filter(|file| file.contents_utf8().is_some_and(is_entry));
    files.filter_map(|file| file.path().to_str()).collect()
}

/// An entry file with all its includes, and the origin of each line.
#[derive(Debug)]
pub struct Resolved {
    /// The complete source.
    pub text: String,
    /// Names of the files in it.
    pub files: Vec<String>,
    /// For each line of the source: index into `files`, and line number there, from 1.
    lines: Vec<(usize, usize)>,
}

impl Resolved {
    /// Origin of a line of the source (from 1), such as `shaders/air.wgsl:12`.
    pub fn origin(&self, line: usize) -> String {
        match self.lines.get(line.saturating_sub(1)) {
            Some(&(file, line)) => format!("shaders/{}:{line}", self.files[file]),
            None => format!("shaders/{}", self.files.first().map_or("?", String::as_str)),
        }
    }
}

/// The folder for hot reload: in debug builds, if it exists.
fn disk_folder() -> Option<PathBuf> {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders"));
    (cfg!(debug_assertions) && folder.is_dir()).then_some(folder)
}

/// Source of one file: from disk in debug builds, else the embedded one.
fn read(name: &str) -> Option<Cow<'static, str>> {
    if name == SHARED {
        return Some(Cow::Owned(shared::text()));
    }
    let on_disk = disk_folder().and_then(|folder| std::fs::read_to_string(folder.join(name)).ok());
    on_disk.map(Cow::Owned).or_else(|| EMBEDDED.get_file(name)?.contents_utf8().map(Cow::Borrowed))
}

/// Resolves the includes of an entry file. `read` returns the source of a file by name.
pub fn resolve_with(entry: &str, read: &dyn Fn(&str) -> Option<Cow<'static, str>>) -> Result<Resolved, RenderError> {
    let mut resolved = Resolved { text: String::new(), files: Vec::new(), lines: Vec::new() };
    append(entry, &format!("shaders/{entry}"), read, &mut Vec::new(), &mut resolved)?;
    Ok(resolved)
}

/// Resolves the includes of an entry file of `shaders/`.
pub fn resolve(entry: &str) -> Result<Resolved, RenderError> {
    resolve_with(entry, &read)
}

/// WGSL for the shaders of a game that draws in the air of a body: `light_at` (irradiance of suns and sky on a
/// surface), `shaded_light_at` (the same in shadows), `haze_before` (aerial perspective of a point) and the uniforms.
/// Append the game's source to it. It uses bind groups 0 and 1 ([`super::Renderer::body_layouts`]), so the game's own
/// groups begin at 2.
///
/// # Errors
/// [`RenderError::Shader`]: a file of `shaders/` was edited on disk and an include is missing.
pub fn air_wgsl() -> Result<String, RenderError> {
    Ok(resolve("air_api.wgsl")?.text)
}

/// WGSL for the shaders of a game that draw a [`super::ShadowCaster`]: `shadow_view`, in bind group 0
/// ([`super::Renderer::caster_layout`]). Append the game's source to it; the game's own groups begin at 1.
///
/// # Errors
/// As [`air_wgsl`].
pub fn caster_wgsl() -> Result<String, RenderError> {
    Ok(resolve("caster_api.wgsl")?.text)
}

fn append(
    name: &str,
    asked_at: &str,
    read: &dyn Fn(&str) -> Option<Cow<'static, str>>,
    open: &mut Vec<String>,
    out: &mut Resolved,
) -> Result<(), RenderError> {
    if open.iter().any(|n| n == name) {
        let circle = open.join("` -> `");
        return Err(RenderError::Shader(format!("{asked_at}: `{circle}` -> `{name}` include each other")));
    }
    if out.files.iter().any(|n| n == name) {
        return Ok(());
    }
    let text =
        read(name).ok_or_else(|| RenderError::Shader(format!("{asked_at}: there is no shader file `{name}`")))?;
    let file = out.files.len();
    out.files.push(name.to_owned());
    open.push(name.to_owned());
    for (i, line) in text.lines().enumerate() {
        if let Some(rest) = line.trim_start().strip_prefix("#include") {
            let at = format!("shaders/{name}:{}", i + 1);
            let included = rest.trim().strip_prefix('"').and_then(|r| r.strip_suffix('"'));
            let included =
                included.ok_or_else(|| RenderError::Shader(format!("{at}: write `#include \"name.wgsl\"`")))?;
            append(included, &at, read, open, out)?;
        } else {
            out.text.push_str(line);
            out.text.push('\n');
            out.lines.push((file, i + 1));
        }
    }
    open.pop();
    Ok(())
}

/// Resolves and validates an entry file, so that no invalid shader reaches the driver.
pub fn check(entry: &str) -> Result<Resolved, RenderError> {
    let resolved = resolve(entry)?;
    check_resolved(&resolved)?;
    Ok(resolved)
}

/// Parses and validates a resolved source. An error names file and line of the origin.
pub fn check_resolved(resolved: &Resolved) -> Result<(), RenderError> {
    let module = naga::front::wgsl::parse_str(&resolved.text).map_err(|error| {
        let line = error.location(&resolved.text).map_or(0, |l| l.line_number as usize);
        RenderError::Shader(format!("{}: {}", resolved.origin(line), error.message()))
    })?;
    let mut validator = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), CAPABILITIES);
    validator.validate(&module).map_err(|error| {
        let line = error.location(&resolved.text).map_or(0, |l| l.line_number as usize);
        let mut message = format!("{}: {}", resolved.origin(line), error.as_inner());
        let mut cause: Option<&dyn std::error::Error> = std::error::Error::source(error.as_inner());
        while let Some(inner) = cause {
            message = format!("{message}: {inner}");
            cause = inner.source();
        }
        RenderError::Shader(message)
    })?;
    Ok(())
}

/// Compiles the shader module of an entry file.
pub(crate) fn module(device: &wgpu::Device, entry: &str) -> Result<wgpu::ShaderModule, RenderError> {
    let resolved = check(entry)?;
    Ok(device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(entry),
        source: wgpu::ShaderSource::Wgsl(resolved.text.into()),
    }))
}

/// Watches the files on disk; inactive in release builds.
pub(crate) struct Watch {
    looked: Instant,
    newest: Option<SystemTime>,
}

impl Watch {
    /// Watches for changes from now on.
    pub(crate) fn new() -> Self {
        Self { looked: Instant::now(), newest: newest_change() }
    }

    /// Whether a file has changed since the last call. Checks at most twice a second.
    pub(crate) fn changed(&mut self) -> bool {
        if self.looked.elapsed() < Duration::from_millis(500) {
            return false;
        }
        self.looked = Instant::now();
        let newest = newest_change();
        let changed = newest != self.newest;
        self.newest = newest;
        changed
    }
}

fn newest_change() -> Option<SystemTime> {
    let folder = disk_folder()?;
    EMBEDDED.files().filter_map(|file| std::fs::metadata(folder.join(file.path())).ok()?.modified().ok()).max()
}
