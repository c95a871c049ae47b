//! Stand-in for reading scene files, to be replaced.

use super::Scene;
use serde::Serialize;
use std::path::{Path, PathBuf};

pub struct Loaded {
    pub scene: Scene,
    pub warnings: Vec<Diagnostic>,
    pub files: Vec<PathBuf>,
    pub folder: PathBuf,
    pub hash: [u8; 32],
}

#[derive(Debug)]
pub struct Report {
    pub diagnostics: Vec<Diagnostic>,
    unreadable: bool,
}

impl Report {
    pub fn exit_code(&self) -> u8 {
        if self.unreadable { 3 } else { 2 }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    Error,
    Warning,
}

#[derive(Clone, Debug, Serialize)]
pub struct Diagnostic {
    pub severity: Severity,
    pub message: String,
}

impl std::fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "error: {}", self.message)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Ron,
    Toml,
}

impl Format {
    pub fn from_path(path: &Path) -> Option<Format> {
        match path.extension()?.to_str()? {
            "ron" => Some(Format::Ron),
            "toml" => Some(Format::Toml),
            _ => None,
        }
    }
}

fn report(message: String, unreadable: bool) -> Report {
    Report { diagnostics: vec![Diagnostic { severity: Severity::Error, message }], unreadable }
}

pub fn load(path: &Path, overrides: &[String]) -> Result<Loaded, Report> {
    let text = std::fs::read_to_string(path).map_err(|e| report(format!("{}: {e}", path.display()), true))?;
    let format = Format::from_path(path).ok_or_else(|| report("unknown format".into(), false))?;
    let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
    let mut loaded = load_str(&text, format, &folder, overrides)
        .map_err(|r| report(format!("{}: {}", path.display(), r.diagnostics[0].message), r.unreadable))?;
    loaded.files.insert(0, path.to_path_buf());
    Ok(loaded)
}

pub fn load_str(text: &str, format: Format, folder: &Path, overrides: &[String]) -> Result<Loaded, Report> {
    let mut scene: Scene = match format {
        Format::Ron => ron::Options::default()
            .with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME)
            .from_str(text)
            .map_err(|e| report(e.to_string(), false))?,
        Format::Toml => toml::from_str(text).map_err(|e| report(e.to_string(), false))?,
    };
    for pair in overrides {
        match pair.strip_prefix("image.width=").map(str::parse) {
            Some(Ok(width)) => scene.image.width = width,
            _ => return Err(report(format!("--set {pair}"), false)),
        }
    }
    if scene.camera.is_none() {
        return Err(report("camera: missing".into(), false));
    }
    let mut files = Vec::new();
    for name in &scene.include {
        let file = folder.join(name);
        std::fs::metadata(&file).map_err(|e| report(format!("{}: {e}", file.display()), true))?;
        files.push(file);
    }
    Ok(Loaded { scene, warnings: Vec::new(), files, folder: folder.to_path_buf(), hash: [7; 32] })
}

pub fn to_string(scene: &Scene, format: Format) -> Result<String, String> {
    match format {
        Format::Ron => ron::ser::to_string_pretty(
            scene,
            ron::ser::PrettyConfig::new().extensions(ron::extensions::Extensions::IMPLICIT_SOME),
        )
        .map_err(|e| e.to_string()),
        Format::Toml => toml::to_string(scene).map_err(|e| e.to_string()),
    }
}

pub fn json_schema() -> serde_json::Value {
    schemars::schema_for!(Scene).to_value()
}
