//! The classic test grid: eight by eight coloured cells, labelled A1 (top left) to H8 (bottom
//! right), so that turned, mirrored or stretched texture coordinates show at once.

use glam::DVec3;

use super::super::image::{Image, hex};

const CELLS: usize = 8;
/// Pixels a cell, and a dot of a letter.
const CELL: usize = 64;
const DOT: usize = 5;

/// Letters and figures, 5 wide and 7 high, a row a number, the leftmost dot the highest bit.
const LETTERS: [[u8; 7]; 8] = [
    [0b01110, 0b10001, 0b10001, 0b11111, 0b10001, 0b10001, 0b10001],
    [0b11110, 0b10001, 0b10001, 0b11110, 0b10001, 0b10001, 0b11110],
    [0b01110, 0b10001, 0b10000, 0b10000, 0b10000, 0b10001, 0b01110],
    [0b11110, 0b10001, 0b10001, 0b10001, 0b10001, 0b10001, 0b11110],
    [0b11111, 0b10000, 0b10000, 0b11110, 0b10000, 0b10000, 0b11111],
    [0b11111, 0b10000, 0b10000, 0b11110, 0b10000, 0b10000, 0b10000],
    [0b01110, 0b10001, 0b10000, 0b10111, 0b10001, 0b10001, 0b01110],
    [0b10001, 0b10001, 0b10001, 0b11111, 0b10001, 0b10001, 0b10001],
];
const FIGURES: [[u8; 7]; 8] = [
    [0b00100, 0b01100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110],
    [0b01110, 0b10001, 0b00001, 0b00110, 0b01000, 0b10000, 0b11111],
    [0b11110, 0b00001, 0b00001, 0b01110, 0b00001, 0b00001, 0b11110],
    [0b00010, 0b00110, 0b01010, 0b10010, 0b11111, 0b00010, 0b00010],
    [0b11111, 0b10000, 0b11110, 0b00001, 0b00001, 0b10001, 0b01110],
    [0b01110, 0b10000, 0b10000, 0b11110, 0b10001, 0b10001, 0b01110],
    [0b11111, 0b00001, 0b00010, 0b00100, 0b01000, 0b01000, 0b01000],
    [0b01110, 0b10001, 0b10001, 0b01110, 0b10001, 0b10001, 0b01110],
];

/// Cells of two alternating rows of colours.
const COLOURS: [u32; 8] = [0xd9534f, 0xe8964a, 0xe3c64b, 0x7fb94f, 0x4fb3a5, 0x4a8fd0, 0x7a6bc4, 0xc266a8];

/// The grid.
pub fn cells() -> Image {
    let size = CELLS * CELL;
    Image::paint(size, |x, y| {
        let (px, py) = ((x * size as f64) as usize, (y * size as f64) as usize);
        let (column, row) = (px / CELL, py / CELL);
        let (dx, dy) = (px % CELL, py % CELL);
        let base = hex(COLOURS[(column + row * 3) % 8]);
        let light = (column + row) % 2 == 0;
        let ground = if light { base.lerp(DVec3::ONE, 0.55) } else { base * 0.55 };
        let ink = if light { hex(0x1d1d1d) } else { hex(0xf7f7f7) };
        let border = dx == 0 || dy == 0 || dx == CELL - 1 || dy == CELL - 1;
        if label(column, row, dx, dy) || border { ink } else { ground }
    })
}

/// Whether the label covers a pixel of its cell.
fn label(column: usize, row: usize, dx: usize, dy: usize) -> bool {
    // Two glyphs of five dots and one dot between them.
    let (left, top) = ((CELL - 11 * DOT) / 2, (CELL - 7 * DOT) / 2);
    if dx < left || dy < top {
        return false;
    }
    let (x, y) = ((dx - left) / DOT, (dy - top) / DOT);
    let (glyph, x) = if x < 6 { (LETTERS[row], x) } else { (FIGURES[column], x - 6) };
    x < 5 && y < 7 && glyph[y] >> (4 - x) & 1 == 1
}
