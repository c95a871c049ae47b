//! Pictures to a viewer that speaks tev's protocol (github.com/Tom94/tev), over TCP, while they are made.
//!
//! A thread of its own sends; whoever renders only leaves the newest picture for it, and never waits. A
//! viewer that is slow gets fewer pictures, one that goes away gets none until it is back.
//!
//! A packet is its length (u32, itself included), its kind (u8) and its content, all little-endian;
//! texts end with a zero.

use std::io::{self, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Where tev listens unless told otherwise.
pub const DEFAULT_PORT: u16 = 14158;

const CREATE_IMAGE: u8 = 4;
const UPDATE_IMAGE: u8 = 6;
const CHANNELS: [&str; 3] = ["R", "G", "B"];

/// Rows of a packet: small enough that a viewer shows the picture as it comes.
const BAND: usize = 64;
/// A viewer that takes no bytes for this long has gone away.
const PATIENCE: Duration = Duration::from_secs(2);
/// After a failure the viewer is left alone for this long.
const PAUSE: Duration = Duration::from_secs(1);

/// A viewer, by its address.
#[derive(Debug)]
pub struct Display {
    shared: Arc<Shared>,
}

#[derive(Debug, Default)]
struct Shared {
    slot: Mutex<Slot>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct Slot {
    /// The newest picture, until it is taken.
    next: Option<Picture>,
    sending: bool,
    closed: bool,
    /// What went wrong since it was asked for last.
    trouble: Option<String>,
}

/// Linear red, green and blue of each pixel, rows from the top.
#[derive(Debug)]
struct Picture {
    width: usize,
    height: usize,
    rgb: Vec<f32>,
}

impl Display {
    /// A viewer at `host:port` (or `host`), which need not be there yet; `name` is the picture's there.
    ///
    /// # Errors
    /// The address has no such form; no thread can be started.
    pub fn new(address: &str, name: &str) -> io::Result<Display> {
        let (host, port) = match address.rsplit_once(':') {
            Some((host, port)) => (host, port.parse::<u16>().ok()),
            None => (address, Some(DEFAULT_PORT)),
        };
        let Some(port) = port.filter(|_| !host.is_empty()) else {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "expected host:port"));
        };
        let shared = Arc::new(Shared::default());
        let viewer = Viewer {
            // as in addresses of the web
            host: host.trim_start_matches('[').trim_end_matches(']').to_owned(),
            port,
            name: name.replace('\0', " "),
            stream: None,
            size: (0, 0),
            failed: None,
        };
        let own = Arc::clone(&shared);
        thread::Builder::new().name("display".to_owned()).spawn(move || own.serve(viewer))?;
        Ok(Display { shared })
    }

    /// Whether the picture before has gone: another one would be seen.
    pub fn ready(&self) -> bool {
        let slot = self.shared.lock();
        slot.next.is_none() && !slot.sending
    }

    /// Leaves a picture to be sent, in the place of one that was not; does not wait. `rgb` holds
    /// `3 · width · height` values.
    pub fn show(&self, width: usize, height: usize, rgb: Vec<f32>) {
        self.shared.lock().next = Some(Picture { width, height, rgb });
        self.shared.changed.notify_all();
    }

    /// What went wrong, once.
    pub fn trouble(&self) -> Option<String> {
        self.shared.lock().trouble.take()
    }

    /// Waits for the last picture to arrive, but not long.
    pub fn finish(&self) {
        let slot = self.shared.lock();
        let unsent = |slot: &mut Slot| slot.next.is_some() || slot.sending;
        drop(self.shared.changed.wait_timeout_while(slot, PATIENCE, unsent));
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        self.shared.lock().closed = true;
        self.shared.changed.notify_all();
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Slot> {
        // every state of the slot is sound
        self.slot.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn serve(&self, mut viewer: Viewer) {
        loop {
            let mut slot = self.lock();
            let picture = loop {
                if let Some(picture) = slot.next.take() {
                    break picture;
                }
                if slot.closed {
                    return;
                }
                slot = self.changed.wait(slot).unwrap_or_else(PoisonError::into_inner);
            };
            slot.sending = true;
            drop(slot);
            let outcome = viewer.show(&picture);
            let mut slot = self.lock();
            slot.sending = false;
            if let Err(error) = outcome {
                slot.trouble = Some(format!("{}:{}: {error}", viewer.host, viewer.port));
            }
            drop(slot);
            self.changed.notify_all();
        }
    }
}

struct Viewer {
    host: String,
    port: u16,
    name: String,
    stream: Option<TcpStream>,
    /// Of the picture that the viewer has.
    size: (usize, usize),
    failed: Option<Instant>,
}

impl Viewer {
    fn show(&mut self, picture: &Picture) -> io::Result<()> {
        if self.failed.is_some_and(|failed| failed.elapsed() < PAUSE) {
            return Ok(());
        }
        let outcome = self.send(picture);
        self.failed = outcome.is_err().then(Instant::now);
        if outcome.is_err() {
            self.stream = None;
        }
        outcome
    }

    fn send(&mut self, picture: &Picture) -> io::Result<()> {
        if self.stream.is_none() {
            (self.stream, self.size) = (Some(connect(&self.host, self.port)?), (0, 0));
        }
        let Some(stream) = &mut self.stream else { return Ok(()) };
        if self.size != (picture.width, picture.height) {
            stream.write_all(&create(&self.name, picture))?;
            self.size = (picture.width, picture.height);
        }
        for first in (0..picture.height).step_by(BAND) {
            let rows = first..(first + BAND).min(picture.height);
            stream.write_all(&update(&self.name, picture, rows))?;
        }
        stream.flush()
    }
}

fn connect(host: &str, port: u16) -> io::Result<TcpStream> {
    let mut last = io::Error::new(io::ErrorKind::NotFound, "no such host");
    for address in (host, port).to_socket_addrs()? {
        match TcpStream::connect_timeout(&address, PATIENCE) {
            Ok(stream) => {
                stream.set_write_timeout(Some(PATIENCE))?;
                stream.set_nodelay(true)?;
                return Ok(stream);
            }
            Err(error) => last = error,
        }
    }
    Err(last)
}

/// A picture that is not there yet, or of another size.
fn create(name: &str, picture: &Picture) -> Vec<u8> {
    let mut packet = Packet::new(CREATE_IMAGE);
    packet.flag(false);
    packet.text(name);
    packet.ints(&[picture.width, picture.height, CHANNELS.len()]);
    CHANNELS.iter().for_each(|channel| packet.text(channel));
    packet.finish()
}

/// Some rows of it, pixel after pixel.
fn update(name: &str, picture: &Picture, rows: std::ops::Range<usize>) -> Vec<u8> {
    let mut packet = Packet::new(UPDATE_IMAGE);
    packet.flag(false);
    packet.text(name);
    packet.ints(&[CHANNELS.len()]);
    CHANNELS.iter().for_each(|channel| packet.text(channel));
    packet.ints(&[0, rows.start, picture.width, rows.len()]);
    for offset in 0..CHANNELS.len() as i64 {
        packet.0.extend(offset.to_le_bytes());
    }
    for _ in CHANNELS {
        packet.0.extend((CHANNELS.len() as i64).to_le_bytes());
    }
    let row = CHANNELS.len() * picture.width;
    let values = picture.rgb.get(rows.start * row..rows.end * row).unwrap_or_default();
    packet.0.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    packet.finish()
}

struct Packet(Vec<u8>);

impl Packet {
    fn new(kind: u8) -> Packet {
        Packet(vec![0, 0, 0, 0, kind])
    }

    fn flag(&mut self, flag: bool) {
        self.0.push(flag.into());
    }

    fn text(&mut self, text: &str) {
        self.0.extend(text.as_bytes());
        self.0.push(0);
    }

    fn ints(&mut self, values: &[usize]) {
        // images have at most 2^20 pixels a side
        values.iter().for_each(|value| self.0.extend((*value as i32).to_le_bytes()));
    }

    fn finish(mut self) -> Vec<u8> {
        let length = self.0.len() as u32;
        self.0[..4].copy_from_slice(&length.to_le_bytes());
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packets_are_laid_out_as_the_protocol_says() {
        let picture = Picture { width: 2, height: 1, rgb: vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0] };
        let packet = create("ab", &picture);
        let expected = b"\x1b\0\0\0\x04\0ab\0\x02\0\0\0\x01\0\0\0\x03\0\0\0R\0G\0B\0";
        assert_eq!(packet, expected);
        let packet = update("a", &picture, 0..1);
        assert_eq!(packet.len(), 4 + 1 + 1 + 2 + 4 + 6 + 16 + 24 + 24 + 24);
        assert_eq!(packet[..4], (packet.len() as u32).to_le_bytes());
        assert_eq!(packet[4], 6);
        assert_eq!(packet[packet.len() - 4..], 6.0f32.to_le_bytes());
    }

    #[test]
    fn addresses_have_a_host_and_may_have_a_port() {
        for wrong in ["", ":1", "host:", "host:x", "host:70000"] {
            assert!(Display::new(wrong, "picture").is_err(), "{wrong}");
        }
        for fine in ["localhost", "127.0.0.1:14158", "[::1]:14158"] {
            assert!(Display::new(fine, "picture").is_ok(), "{fine}");
        }
    }
}
