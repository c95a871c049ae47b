//! `watch` and `--display-server`: the picture while it is rendered, and viewers that come and go.

use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const SCENE: &str = r#"(
    camera: (eye: (0, 1, 5), target: (0, 0, 0)),
    image: (width: 70, height: 150),
    render: (passes: 3),
    include: ["white.ron"],
    lights: { "lamp": point(position: (0, 4, 3), intensity: (20, 20, 20)) },
    objects: [ (shape: sphere(radius: 1), material: "white") ],
)"#;
const WHITE: &str = r#"(materials: { "white": (diffuse: (0.8, 0.5, 0.2)) })"#;

fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("scene.ron"), SCENE).expect("written");
    fs::write(folder.path().join("white.ron"), WHITE).expect("written");
    folder
}

fn terrarium(folder: &TempDir, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_terrarium"));
    command.current_dir(folder.path()).args(arguments.split(' ')).stdin(Stdio::null());
    command
}

/// A viewer's pictures by name: width and pixels.
type Pictures = BTreeMap<String, (usize, Vec<[f32; 3]>)>;

/// One packet's kind and content.
fn packet(stream: &mut TcpStream) -> Option<(u8, Vec<u8>)> {
    let mut length = [0; 4];
    stream.read_exact(&mut length).ok()?;
    let mut content = vec![0; u32::from_le_bytes(length).checked_sub(4)? as usize];
    stream.read_exact(&mut content).ok()?;
    Some((content[0], content.split_off(1)))
}

/// Reads little-endian values and texts one after another.
struct Fields<'a>(&'a [u8]);

impl Fields<'_> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let (value, rest) = self.0.split_first_chunk().expect("the packet is long enough");
        self.0 = rest;
        *value
    }

    fn int(&mut self) -> usize {
        i32::from_le_bytes(self.take()).try_into().expect("not negative")
    }

    fn text(&mut self) -> String {
        let end = self.0.iter().position(|byte| *byte == 0).expect("texts end");
        let text = String::from_utf8(self.0[..end].to_vec()).expect("UTF-8");
        self.0 = &self.0[end + 1..];
        text
    }
}

/// What tev does with a packet.
fn show(pictures: &mut Pictures, kind: u8, content: &[u8]) {
    let mut fields = Fields(content);
    let _grab_focus = fields.take::<1>();
    let name = fields.text();
    match kind {
        4 => {
            let (width, height, channels) = (fields.int(), fields.int(), fields.int());
            assert_eq!((0..channels).map(|_| fields.text()).collect::<String>(), "RGB");
            pictures.insert(name, (width, vec![[0.0; 3]; width * height]));
        }
        6 => {
            let (width, pixels) = pictures.get_mut(&name).expect("it was created");
            let channels: Vec<String> = (0..fields.int()).map(|_| fields.text()).collect();
            let (x, y, columns, rows) = (fields.int(), fields.int(), fields.int(), fields.int());
            let longs = |fields: &mut Fields| -> Vec<usize> {
                channels.iter().map(|_| i64::from_le_bytes(fields.take()) as usize).collect()
            };
            let (offsets, strides) = (longs(&mut fields), longs(&mut fields));
            let data: Vec<f32> =
                fields.0.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().expect("4"))).collect();
            for channel in 0..channels.len() {
                for i in 0..columns * rows {
                    let at = (y + i / columns) * *width + x + i % columns;
                    pixels[at][channel] = data[offsets[channel] + i * strides[channel]];
                }
            }
            let end = offsets[2] + (columns * rows - 1) * strides[2] + 1;
            assert_eq!(data.len(), end, "no more and no less than the values");
        }
        other => panic!("packet of kind {other}"),
    }
}

/// A viewer for one connection: its address, and what it shows when that is closed.
fn viewer() -> (String, thread::JoinHandle<(Pictures, usize)>) {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("an address").to_string();
    let thread = thread::spawn(move || {
        let (mut stream, _) = listener.accept().expect("the program connects");
        let (mut pictures, mut packets) = (Pictures::new(), 0);
        while let Some((kind, content)) = packet(&mut stream) {
            show(&mut pictures, kind, &content);
            packets += 1;
        }
        (pictures, packets)
    });
    (address, thread)
}

#[test]
fn the_display_server_shows_what_the_file_holds() {
    let folder = folder();
    let (address, thread) = viewer();
    let done =
        terrarium(&folder, &format!("render scene.ron -o a.exr -q --display-server {address}")).output();
    let done = done.expect("the program runs");
    assert!(done.status.success() && done.stderr.is_empty(), "{}", String::from_utf8_lossy(&done.stderr));
    let (pictures, packets) = thread.join().expect("the viewer understood everything");
    let (width, pixels) = &pictures["scene.ron"];
    let image = terrarium::measure::read::load(&folder.path().join("a.exr")).expect("an image");
    let [r, g, b] = image.layers[0].colour().expect("a picture");
    assert_eq!((*width, pixels.len()), (image.width, image.width * image.height));
    assert!((0..r.len()).all(|i| pixels[i] == [r[i], g[i], b[i]]));
    // three bands of rows, and the first pass before the last
    assert!(packets > 2 * 3, "{packets} packets");
}

/// The wall time of a render that is shown at an address, which must succeed and be whole.
fn shown(folder: &TempDir, address: &str) -> (Duration, String) {
    let began = Instant::now();
    let call = format!("render scene.ron -o b.exr --progress none --passes 40 --display-server {address}");
    let done = terrarium(folder, &call).output().expect("the program runs");
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(done.status.success(), "{said}");
    (began.elapsed(), said)
}

#[test]
fn a_viewer_that_goes_away_or_falls_asleep_neither_stops_nor_changes_the_render() {
    let folder = folder();
    let plain = terrarium(&folder, "render scene.ron -o a.exr -q --passes 40").status();
    assert!(plain.is_ok_and(|status| status.success()));
    let expected = fs::read(folder.path().join("a.exr")).expect("an image");
    let whole = || fs::read(folder.path().join("b.exr")).expect("an image") == expected;

    // nobody there
    let (nobody, said) = shown(&folder, "127.0.0.1:9");
    assert!(whole() && said.matches("display server").count() == 1, "{said}");
    assert!(nobody < Duration::from_secs(20), "{nobody:?}");

    // goes away after the first bytes
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("an address").to_string();
    let thread = thread::spawn(move || {
        let (mut stream, _) = listener.accept().expect("the program connects");
        let mut some = [0; 100];
        stream.read_exact(&mut some).expect("it sends");
    });
    let (gone, _) = shown(&folder, &address);
    thread.join().expect("it was there");
    assert!(whole() && gone < Duration::from_secs(20), "{gone:?}");

    // takes the connection and reads nothing
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("an address").to_string();
    let (asleep, _) = shown(&folder, &address);
    drop(listener);
    assert!(whole() && asleep < Duration::from_secs(20), "{asleep:?}");
    // no address at all is a wrong call
    let done =
        terrarium(&folder, "render scene.ron -o c.exr --display-server nowhere:x").output().expect("it runs");
    assert_eq!(done.status.code(), Some(2));
}

/// A watching program and its lines on standard error; ended with the test.
struct Watching {
    child: Child,
    lines: Receiver<String>,
}

impl Watching {
    fn start(folder: &TempDir, arguments: &str) -> Watching {
        let mut child = terrarium(folder, arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let (sender, lines) = channel();
        let stderr = child.stderr.take().expect("it is piped");
        thread::spawn(move || {
            BufReader::new(stderr).lines().map_while(Result::ok).for_each(|line| drop(sender.send(line)));
        });
        Watching { child, lines }
    }

    /// Waits for a line that contains a text.
    fn expect(&self, text: &str) -> String {
        let began = Instant::now();
        let mut seen = Vec::new();
        while began.elapsed() < Duration::from_secs(60) {
            let Ok(line) = self.lines.recv_timeout(Duration::from_secs(60)) else { break };
            if line.contains(text) {
                return line;
            }
            seen.push(line);
        }
        panic!("no line with `{text}` in {seen:#?}");
    }
}

impl Drop for Watching {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

#[test]
fn watch_renders_anew_on_every_change_and_outlives_mistakes() {
    let folder = folder();
    let change = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("written");
    let watching = Watching::start(&folder, "watch scene.ron");
    watching.expect("70 × 150 pixels, 3 passes");
    watching.expect("3 passes, error");
    change("scene.ron", &SCENE.replace("width: 70", "width: 33"));
    watching.expect("changed: scene.ron");
    watching.expect("33 × 150 pixels");
    watching.expect("waiting for changes of 2 files");
    // an included file, and a mistake in it
    change("white.ron", &WHITE.replace("0.8", "-0.8"));
    watching.expect("changed: white.ron");
    watching.expect("-0.8 is outside [0, 1]");
    change("white.ron", &WHITE.replace("0.8", "0.75"));
    watching.expect("changed: white.ron");
    watching.expect("33 × 150 pixels");
    watching.expect("waiting");
    // text that is no scene, then a texture that is not there yet
    change("scene.ron", "(camera: ");
    watching.expect("error");
    let textured = SCENE.replace(
        "include",
        "textures: { \"t\": image(path: \"t.png\") }, materials: { \"m\": (diffuse: texture(\"t\")) }, include",
    );
    change("scene.ron", &textured.replace("material: \"white\"", "material: \"m\""));
    watching.expect("t.png");
    image::RgbImage::new(2, 1).save(folder.path().join("t.png")).expect("written");
    watching.expect("waiting for changes of 3 files");
    image::RgbImage::new(4, 4).save(folder.path().join("t.png")).expect("written");
    watching.expect("changed: t.png");
    watching.expect("waiting");
}

#[test]
fn a_change_ends_a_render_that_is_under_way() {
    let folder = folder();
    let watching = Watching::start(&folder, "watch scene.ron --passes 1000000");
    watching.expect("1000000 passes");
    fs::write(folder.path().join("white.ron"), WHITE.replace("0.8", "0.7")).expect("written");
    watching.expect("changed: white.ron");
    watching.expect("1000000 passes");
}

#[test]
fn what_cannot_be_watched_is_refused() {
    let folder = folder();
    for call in ["watch - --scene-format ron", "watch scene.ron --display-server :9"] {
        let done = terrarium(&folder, call).output().expect("the program runs");
        assert_eq!(done.status.code(), Some(2), "{call}: {}", String::from_utf8_lossy(&done.stderr));
    }
}

#[test]
fn watch_shows_its_pictures_in_a_viewer_and_can_end() {
    let folder = folder();
    let (address, thread) = viewer();
    let call = format!("watch scene.ron --renders 1 --display-server {address}");
    let done = terrarium(&folder, &call).output().expect("the program runs");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    assert!(done.stdout.is_empty(), "no picture off a terminal");
    let (pictures, _) = thread.join().expect("the viewer understood everything");
    assert!(pictures["scene.ron"].1.iter().any(|pixel| pixel[0] > 0.0));
}
