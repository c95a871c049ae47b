//! Scenes as text to pictures that can be asked for their numbers.

use std::path::Path;
use terrarium::description::{Format, Loaded, load_str};
use terrarium::render::{Aov, Options, RenderError, Rendered, Silent, render};

/// A render to be: a scene and its options.
#[derive(Clone)]
pub struct Shot {
    text: String,
    /// Values that replace the scene's.
    set: Vec<String>,
    folder: std::path::PathBuf,
    pub options: Options,
}

/// A shot of RON text, as the classic ray tracer sees it: without photons.
pub fn shot(text: impl Into<String>) -> Shot {
    Shot { set: vec!["photons=off".to_owned()], ..focused(text) }
}

/// A shot of RON text as it stands: with the caustics that it calls for.
pub fn focused(text: impl Into<String>) -> Shot {
    let folder = Path::new("").to_owned();
    Shot { text: text.into(), set: Vec::new(), folder, options: Options::default() }
}

impl Shot {
    /// The folder that the scene's files are in.
    pub fn folder(self, folder: &Path) -> Shot {
        Shot { folder: folder.to_owned(), ..self }
    }

    pub fn passes(self, passes: u32) -> Shot {
        self.pass_range(0..passes)
    }

    pub fn pass_range(mut self, passes: std::ops::Range<u32>) -> Shot {
        self.options.passes = Some(passes);
        self
    }

    pub fn seed(mut self, seed: u64) -> Shot {
        self.options.seed = Some(seed);
        self
    }

    pub fn aovs(mut self, aovs: &[Aov]) -> Shot {
        self.options.aovs = aovs.to_vec();
        self
    }

    pub fn load(&self) -> Loaded {
        load_str(&self.text, Format::Ron, &self.folder, &self.set)
            .unwrap_or_else(|report| panic!("{report:?}\n{}", self.text))
    }

    pub fn try_render(&self) -> Result<Picture, RenderError> {
        render(&self.load(), &self.options, &Silent).map(|rendered| Picture { rendered })
    }

    pub fn render(&self) -> Picture {
        self.try_render().unwrap_or_else(|error| panic!("{error}\n{}", self.text))
    }
}

pub struct Picture {
    pub rendered: Rendered,
}

impl Picture {
    pub fn width(&self) -> usize {
        self.rendered.image.width
    }

    pub fn height(&self) -> usize {
        self.rendered.image.height
    }

    pub fn channel(&self, layer: &str, channel: &str) -> &[f32] {
        self.rendered.image.layer(layer).and_then(|l| l.channel(channel)).expect("the layer was asked for")
    }

    /// Row by row from the top.
    pub fn rgb(&self) -> Vec<[f32; 3]> {
        let [r, g, b] = ["R", "G", "B"].map(|c| self.channel("", c));
        (0..r.len()).map(|i| [r[i], g[i], b[i]]).collect()
    }

    /// The red channel, for grey scenes.
    pub fn grey(&self) -> Vec<f64> {
        self.channel("", "R").iter().map(|&x| f64::from(x)).collect()
    }

    pub fn at(&self, x: usize, y: usize) -> f64 {
        self.grey()[y * self.width() + x]
    }

    pub fn mean(&self) -> f64 {
        let grey = self.grey();
        grey.iter().sum::<f64>() / grey.len() as f64
    }

    /// Whether every value is finite and not negative.
    pub fn is_sound(&self) -> bool {
        self.rgb().iter().flatten().all(|x| x.is_finite() && *x >= 0.0)
    }

    pub fn bits(&self) -> Vec<u32> {
        let layers = self.rendered.image.layers.iter();
        layers.flat_map(|l| &l.channels).flat_map(|(_, values)| values.iter().map(|x| x.to_bits())).collect()
    }
}

#[track_caller]
pub fn assert_close(found: f64, expected: f64, relative: f64) {
    let allowed = relative * expected.abs();
    assert!((found - expected).abs() <= allowed, "{found} instead of {expected} ± {allowed:e}");
}

/// The share of pixels of `b` that agree with `a` to within `relative` of the larger value.
pub fn agreement(a: &Picture, b: &Picture, relative: f32) -> f64 {
    let (a, b) = (a.rgb(), b.rgb());
    assert_eq!(a.len(), b.len());
    let same = |p: &[f32; 3], q: &[f32; 3]| {
        (0..3).all(|c| (p[c] - q[c]).abs() <= relative * p[c].abs().max(q[c].abs()))
    };
    a.iter().zip(&b).filter(|(p, q)| same(p, q)).count() as f64 / a.len() as f64
}
