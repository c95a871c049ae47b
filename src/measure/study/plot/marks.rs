//! What drawings are made of. Coordinates are in points from the top left.

/// Red, green and blue as a screen shows them.
pub type Colour = [u8; 3];

/// A drawing on white.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    pub width: f64,
    pub height: f64,
    pub marks: Vec<Mark>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    Line {
        points: Vec<[f64; 2]>,
        colour: Colour,
        width: f64,
        dashed: bool,
    },
    /// `name`: what a page that shows the drawing may call it by.
    Dot {
        at: [f64; 2],
        radius: f64,
        colour: Colour,
        /// Else a ring.
        filled: bool,
        name: String,
        title: String,
    },
    /// `at` is on the base line.
    Text {
        at: [f64; 2],
        size: f64,
        anchor: Anchor,
        colour: Colour,
        /// Read from below.
        upright: bool,
        text: String,
    },
}

/// Which end of a text its place is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

impl Drawing {
    pub fn new(width: f64, height: f64) -> Drawing {
        Drawing { width, height, marks: Vec::new() }
    }

    pub fn line(&mut self, points: Vec<[f64; 2]>, colour: Colour, width: f64) {
        self.marks.push(Mark::Line { points, colour, width, dashed: false });
    }

    pub fn dashes(&mut self, points: Vec<[f64; 2]>, colour: Colour, width: f64) {
        self.marks.push(Mark::Line { points, colour, width, dashed: true });
    }

    pub fn text(&mut self, at: [f64; 2], size: f64, anchor: Anchor, colour: Colour, text: &str) {
        self.marks.push(Mark::Text { at, size, anchor, colour, upright: false, text: text.to_owned() });
    }
}
