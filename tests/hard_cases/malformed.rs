//! Files that are empty, cut off, lie about themselves, or mean harm: what the program makes of each.

use super::record::{row, sized};
use crate::render::meshes::{folder, write_exr};
use std::path::Path;
use std::process::Command;
use std::time::Instant;

const SCENE: &str = r#"(
    camera: (eye: (0, 0, 5), target: (0, 0, 0)), image: (width: 4, height: 4), render: (passes: 1), background: 1,
    textures: { "t": image(path: "image") }, materials: { "m": (emission: texture("t")) },
    objects: [(shape: mesh(path: "mesh.obj"), material: "m")],
)"#;
const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n";

/// A case: which of the three files is replaced by what.
struct Case {
    name: String,
    file: &'static str,
    bytes: Vec<u8>,
}

fn case(name: impl Into<String>, file: &'static str, bytes: impl AsRef<[u8]>) -> Case {
    Case { name: name.into(), file, bytes: bytes.as_ref().to_vec() }
}

fn sound_images(folder: &Path) -> [(&'static str, Vec<u8>); 3] {
    let path = folder.join("whole");
    write_exr(&path, 7, 5, |x, y| [x as f32, y as f32, 0.5]);
    let exr = std::fs::read(&path).expect("written");
    let pixels = image::RgbImage::from_fn(13, 11, |x, y| image::Rgb([x as u8 * 19, y as u8 * 23, 99]));
    let coded = |format| {
        let mut file = std::io::Cursor::new(Vec::new());
        pixels.write_to(&mut file, format).expect("it is written to memory");
        file.into_inner()
    };
    [("png", coded(image::ImageFormat::Png)), ("jpeg", coded(image::ImageFormat::Jpeg)), ("exr", exr)]
}

/// The chunk IHDR with other sides; its checksum is CRC-32.
fn png_of_size(plain: &[u8], width: u32, height: u32) -> Vec<u8> {
    let mut file = plain.to_vec();
    file[16..20].copy_from_slice(&width.to_be_bytes());
    file[20..24].copy_from_slice(&height.to_be_bytes());
    let crc = crc32(&file[12..29]);
    file[29..33].copy_from_slice(&crc.to_be_bytes());
    file
}

fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = !0u32;
    for byte in bytes {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 };
        }
    }
    !crc
}

/// A PNG whose compressed text would be a gigabyte: zeros in stored form cannot be, so that a run of the
/// shortest deflate codes for them is written by hand.
fn png_with_bomb(plain: &[u8]) -> Vec<u8> {
    // zlib head; one fixed block: a literal 0, then runs of 258 at distance 1, a bit pattern of period 13.
    let mut bits: Vec<bool> = vec![true, true, false];
    bits.extend([false, false, true, true, false, false, false, false]);
    for _ in 0..400_000 {
        bits.extend([true, true, false, false, false, true, false, true]);
        bits.extend([false; 5]);
    }
    bits.extend([false; 7]);
    let mut deflated = vec![0x78, 0x9c];
    deflated.extend(
        bits.chunks(8).map(|b| b.iter().enumerate().fold(0u8, |byte, (i, bit)| byte | (u8::from(*bit) << i))),
    );
    let mut chunk = b"zTXtComment\0\0".to_vec();
    chunk.extend(deflated);
    let length = (chunk.len() as u32 - 4).to_be_bytes();
    let crc = crc32(&chunk).to_be_bytes();
    let mut file = plain[..33].to_vec();
    file.extend(length);
    file.extend(chunk);
    file.extend(crc);
    file.extend(&plain[33..]);
    file
}

fn scenes() -> Vec<Case> {
    let scene = |name: &str, text: &str| case(name, "scene.ron", text);
    let toml = |name: &str, text: &str| case(name, "scene.toml", text);
    let camera = "camera: (eye: (0, 0, 5), target: (0, 0, 0))";
    let head = "camera = { eye = [0, 0, 5], target = [0, 0, 0] }\n";
    vec![
        scene("an empty RON scene", ""),
        toml("an empty TOML scene", ""),
        scene("RON nested 1e5 deep", &"(".repeat(100_000)),
        scene("RON lists nested 1e5 deep", &format!("({camera}, objects: {})", "[".repeat(100_000))),
        toml("TOML nested 1e5 deep", &format!("a = {}", "[".repeat(100_000))),
        toml("TOML tables 1e5 deep", &format!("[{}a]", "a.".repeat(100_000))),
        toml("a TOML key given twice", &format!("{head}ambient = 1\nambient = 2\n")),
        toml("a TOML table given twice", &format!("{head}[image]\nwidth = 4\n[image]\nheight = 4\n")),
        scene("a RON field given twice", &format!("({camera}, {camera})")),
        scene("a RON name given twice", &format!("({camera}, materials: {{ \"m\": (), \"m\": () }})")),
        scene("NaN in RON", &format!("({camera}, ambient: NaN)")),
        toml("nan in TOML", &format!("{head}ambient = nan\n")),
        scene("1e999 in RON", &format!("({camera}, ambient: 1e999)")),
        scene("a number of 1e5 digits", &format!("({camera}, ambient: {})", "9".repeat(100_000))),
        case("a scene that is not UTF-8", "scene.ron", b"(camera: \xff\xfe)"),
        case("a scene of zeros", "scene.ron", [0; 4096]),
        scene("a scene that ends in a text", &format!("({camera}, materials: {{ \"m")),
        scene("a comment that does not end", "/* (camera:"),
        scene("a scene that includes itself", &format!("({camera}, include: [\"scene.ron\"])")),
        scene(
            "a scene with a mesh that is a folder",
            &format!(
                "({camera}, materials: {{ \"m\": () }}, objects: [(shape: mesh(path: \"..\"), material: \"m\")])"
            ),
        ),
        scene(
            "a scene with a mesh that is endless",
            &format!(
                "({camera}, materials: {{ \"m\": () }}, objects: [(shape: mesh(path: \"/dev/zero\"), material: \"m\")])"
            ),
        ),
    ]
}

fn meshes() -> Vec<Case> {
    let faces = [
        "f 0 1 2",
        "f 1 2 -99",
        "f 1 2 2147483648",
        "f 1 2 99999999999999999999",
        "f 1 1",
        "f",
        "f 1 2 x",
        "v 1 nan 0",
        "v 1e999 0 0",
        "v 1e300 0 0\nf 1 2 4",
    ];
    let mut list: Vec<Case> = faces
        .iter()
        .map(|line| case(format!("OBJ: {}", line.replace('\n', "; ")), "mesh.obj", format!("{MESH}{line}\n")))
        .collect();
    list.push(case("an empty OBJ", "mesh.obj", ""));
    list.push(case("an OBJ of one line of 20 MB", "mesh.obj", format!("v {}", "1".repeat(20 << 20))));
    list.push(case("an OBJ that is a PNG", "mesh.obj", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"));
    list.push(case(
        "an OBJ that is a PLY",
        "mesh.obj",
        "ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n",
    ));
    list.push(case("an OBJ that is a glTF", "mesh.obj", r#"{"accessors":[{"count":4000000000}]}"#));
    list
}

fn images(folder: &Path) -> Vec<Case> {
    let whole = sound_images(folder);
    let [png, jpeg, exr] = &whole;
    let (png, jpeg, exr) = (&png.1, &jpeg.1, &exr.1);
    let mut list = vec![
        case("an empty image", "image", ""),
        case("an image of a wrong magic", "image", "GIF89a............"),
    ];
    for (w, h) in [(1 << 31, 1), (65_536, 65_536), (u32::MAX, u32::MAX), (0, 5), (20_000, 20_000)] {
        list.push(case(format!("a PNG that says {w} × {h}"), "image", png_of_size(png, w, h)));
    }
    let frame = jpeg.windows(2).position(|w| w == [0xff, 0xc0]).expect("it has a frame") + 5;
    let mut large = jpeg.clone();
    large[frame..frame + 4].copy_from_slice(&[0xff, 0xdc, 0xff, 0xdc]);
    list.push(case("a JPEG that says 65500 × 65500", "image", large));
    let name = b"dataWindow\0box2i\0\x10\0\0\0";
    let at = exr.windows(name.len()).position(|w| w == name).expect("it has one") + name.len();
    for window in [
        [5, 5, 0, 0],
        [0, 0, i32::MAX, i32::MAX],
        [i32::MIN, i32::MIN, i32::MAX, i32::MAX],
        [0, 0, 30_000, 30_000],
    ] {
        let mut file = exr.clone();
        for (i, v) in window.iter().enumerate() {
            file[at + 4 * i..at + 4 * i + 4].copy_from_slice(&v.to_le_bytes());
        }
        list.push(case(format!("an EXR with the data window {window:?}"), "image", file));
    }
    let cuts = sized(2, 40);
    for (name, bytes) in &whole {
        // The last byte, too, is missed.
        for length in (1..=cuts).map(|i| bytes.len() * i / (cuts + 1)).chain([bytes.len() - 1]) {
            list.push(case(format!("a {name} cut to {length} bytes"), "image", &bytes[..length]));
        }
    }
    list
}

/// Runs the program on a case within 256 MiB of data: its exit code, what it says, and seconds.
fn run(folder: &Path, case: &Case) -> (i32, String, f64) {
    let whole = sound_images(folder);
    for (file, bytes) in
        [("scene.ron", SCENE.as_bytes()), ("mesh.obj", MESH.as_bytes()), ("image", &whole[0].1)]
    {
        std::fs::write(folder.join(file), bytes).expect("written");
    }
    std::fs::write(folder.join(case.file), &case.bytes).expect("written");
    let scene = if case.file == "scene.toml" { "scene.toml" } else { "scene.ron" };
    let start = Instant::now();
    let mut program = if cfg!(unix) {
        let mut shell = Command::new("sh");
        shell.args(["-c", "ulimit -d 262144; exec \"$@\"", "sh", env!("CARGO_BIN_EXE_terrarium")]);
        shell
    } else {
        Command::new(env!("CARGO_BIN_EXE_terrarium"))
    };
    let done = program
        .current_dir(folder)
        .args(["render", scene, "-q", "--threads", "1", "-o", "out.exr"])
        .output()
        .expect("the program runs");
    (
        done.status.code().unwrap_or(-1),
        String::from_utf8_lossy(&done.stderr).into_owned(),
        start.elapsed().as_secs_f64(),
    )
}

#[test]
fn h43_malformed_files() {
    row("H43", |row| {
        let dir = folder();
        let cases: Vec<Case> = scenes().into_iter().chain(meshes()).chain(images(dir.path())).collect();
        let (mut wrong, mut panics, mut silent, mut slowest) = (Vec::new(), 0, 0, 0.0f64);
        let (mut placeless, mut texts) = (Vec::new(), 0);
        for case in &cases {
            let (code, said, seconds) = run(dir.path(), case);
            if ![2, 3].contains(&code) {
                wrong.push(format!("{}: code {code}", case.name));
            }
            panics += u64::from(said.contains("panicked"));
            silent +=
                u64::from(!said.contains(case.file) && !said.contains("..") && !said.contains("/dev/zero"));
            slowest = slowest.max(seconds);
            if case.file != "image" {
                texts += 1;
                if !names_a_line(&said) {
                    placeless.push(case.name.clone());
                }
            }
        }
        let named = if wrong.is_empty() { String::new() } else { format!(" ({})", wrong.join("; ")) };
        let n = cases.len() as u64;
        row.none(
            &format!("malformed files that end in another code than 2 or 3, each within 256 MiB{named}"),
            wrong.len() as u64,
            n,
        );
        row.none("panics", panics, n);
        row.none("messages that do not name the file", silent, n);
        let named = if placeless.is_empty() { String::new() } else { format!(" ({})", placeless.join("; ")) };
        row.none(
            &format!("messages on scenes and meshes that do not name the line{named}"),
            placeless.len() as u64,
            texts,
        );
        row.at_most("seconds for the slowest", slowest, 1.0);
        harmless(row, dir.path());
    });
}

/// Whether a message says `file:LINE:`.
fn names_a_line(said: &str) -> bool {
    said.lines().any(|line| {
        let mut parts = line.split(':').skip(1);
        parts.next().is_some_and(|part| part.parse::<u64>().is_ok_and(|n| n > 0))
    })
}

/// What looks odd and is no mistake.
fn harmless(row: &mut super::record::Record, folder: &Path) {
    let whole = sound_images(folder);
    let cases = [
        case("CRLF and a BOM", "scene.ron", format!("\u{feff}{}", SCENE.replace('\n', "\r\n"))),
        case("an OBJ with CRLF and a BOM", "mesh.obj", format!("\u{feff}{}", MESH.replace('\n', "\r\n"))),
        case("a PNG with a zTXt chunk that inflates to 100 MB", "image", png_with_bomb(&whole[0].1)),
    ];
    for case in cases {
        let (code, said, seconds) = run(folder, &case);
        row.is(&format!("exit code of {}", case.name), f64::from(code), 0.0, 0.0);
        row.at_most("its seconds", seconds, 1.0);
        assert!(code == 0, "{}: {said}", case.name);
    }
}
