//! Writes the yardstick's height field as a Wavefront OBJ file: 1024×1024 vertices, 2,093,058
//! triangles over x, z in [−5, 5], y the sum of six octaves of waves.
//!
//! `cargo run --release --example heightfield [FILE]`; without FILE, `scenes/yardstick/heightfield.obj`.

use std::fs::File;
use std::io::{self, BufWriter, Write};

const SIDE: usize = 1024;

fn height(x: f64, z: f64) -> f64 {
    (0..6)
        .map(|octave| {
            let (o, scale) = (octave as f64, (1u32 << octave) as f64);
            0.8 / scale * libm::sin(1.3 * scale * x + 0.7 * o) * libm::cos(1.1 * scale * z + 1.3 * o)
        })
        .sum()
}

fn write_mesh(out: &mut impl Write) -> io::Result<()> {
    let place = |i: usize| -5.0 + 10.0 * i as f64 / (SIDE - 1) as f64;
    writeln!(out, "# height field, {SIDE} x {SIDE} vertices, metres")?;
    for j in 0..SIDE {
        for i in 0..SIDE {
            let (x, z) = (place(i), place(j));
            writeln!(out, "v {} {} {}", x as f32, height(x, z) as f32, z as f32)?;
        }
    }
    for j in 0..SIDE - 1 {
        for i in 0..SIDE - 1 {
            let a = j * SIDE + i + 1;
            let (b, c, d) = (a + 1, a + SIDE, a + SIDE + 1);
            // Counter-clockwise seen from +y; the diagonal runs from (i, j) to (i+1, j+1).
            writeln!(out, "f {a} {c} {d}\nf {a} {d} {b}")?;
        }
    }
    out.flush()
}

fn main() -> io::Result<()> {
    let path = std::env::args_os().nth(1).unwrap_or_else(|| "scenes/yardstick/heightfield.obj".into());
    write_mesh(&mut BufWriter::with_capacity(1 << 20, File::create(path)?))
}
