//! What the process holds, as the system tells it, and the most that it will hold.

/// Bytes that a render will need beyond what is held when the forecast is made.
#[derive(Clone, Copy, Debug, Default)]
pub struct Later {
    pub film: u64,
    /// While the photons of a pass are made beside those of the pass before.
    pub photons: u64,
    /// What threads keep of the tiles that they work on.
    pub tiles: u64,
    /// Layers of the finished image, and of the one that is written.
    pub image: u64,
}

/// Held now, and at most so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Held {
    pub now: u64,
    pub most: u64,
}

/// Bytes in memory, from Linux's `/proc`; `None` elsewhere.
pub fn held() -> Option<Held> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let bytes = |name: &str| -> Option<u64> {
        let line = status.lines().find_map(|line| line.strip_prefix(name))?;
        let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
        Some(kib * 1024)
    };
    Some(Held { now: bytes("VmRSS:")?, most: bytes("VmHWM:")? })
}

/// Bytes that the machine has, from Linux's `/proc`; `None` elsewhere.
pub fn machine() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}

impl Held {
    /// The most that will have been held in the end.
    pub fn peak(&self, later: &Later) -> u64 {
        // Not all at once; but what one stage frees, the next does not find in its own sizes and threads.
        (self.now + later.film + later.photons + later.tiles + later.image).max(self.most)
    }
}

/// Forgets the highest memory so far, where the system can (Linux's `clear_refs`): `most` then begins with
/// what is held now.
pub fn forget_most() {
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}
