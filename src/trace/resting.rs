//! Pixels that need no more samples, in blocks that do not depend on the tiles.

/// Which blocks of an image's pixels rest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Resting {
    across: u32,
    blocks: Vec<bool>,
}

impl Resting {
    /// Pixels along a block's side.
    pub const SIDE: u32 = 8;

    /// None of an image's blocks.
    pub fn none(width: u32, height: u32) -> Resting {
        let across = width.div_ceil(Self::SIDE);
        Resting { across, blocks: vec![false; across as usize * height.div_ceil(Self::SIDE) as usize] }
    }

    /// Blocks in a row, and rows of them.
    pub fn size(&self) -> [u32; 2] {
        [self.across, self.blocks.len() as u32 / self.across.max(1)]
    }

    /// The block of a pixel.
    #[inline]
    pub fn block(&self, x: u32, y: u32) -> usize {
        (y / Self::SIDE) as usize * self.across as usize + (x / Self::SIDE) as usize
    }

    /// Whether a pixel rests.
    #[inline]
    pub fn has(&self, x: u32, y: u32) -> bool {
        self.blocks[self.block(x, y)]
    }

    pub fn blocks(&self) -> &[bool] {
        &self.blocks
    }

    pub fn all(&self) -> bool {
        self.blocks.iter().all(|rests| *rests)
    }

    pub fn rest(&mut self, block: usize) {
        self.blocks[block] = true;
    }
}
