//! Files that appear whole or not at all.
//!
//! The bytes go to a temporary file beside the target (`.name.tmp-<process>-<n>`), are flushed to
//! the disk, and take the target's name in one step; the folder is flushed last. Until then a file
//! that was there stays as it was. Devices and pipes (`/dev/null`, a FIFO) can't be replaced so
//! and are written directly.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// A file being written. Dropped without `commit`, it leaves nothing behind.
#[derive(Debug)]
pub struct Pending {
    file: File,
    /// The temporary file; none where the target is written directly, and after `commit`.
    temporary: Option<PathBuf>,
    target: PathBuf,
}

/// Whether `target` can be written: the error that writing it would meet now, if any.
///
/// Creates the temporary file and removes it at once, so that a run that is killed later leaves
/// nothing behind.
pub fn probe(target: &Path) -> io::Result<()> {
    Pending::create(target).map(drop)
}

impl Pending {
    /// Begins to write `target`. Fails if its folder is missing or can't be written, if it is a
    /// folder, or if it exists and is read-only.
    pub fn create(target: &Path) -> io::Result<Self> {
        // a link is kept and what it points to is replaced
        let target = if target.is_symlink() { fs::canonicalize(target)? } else { target.to_path_buf() };
        let found = fs::metadata(&target).ok();
        let refused = |kind, reason: &str| Err(io::Error::new(kind, reason));
        if let Some(found) = &found {
            if found.is_dir() {
                return refused(io::ErrorKind::IsADirectory, "is a folder");
            }
            if !found.is_file() {
                let file = OpenOptions::new().write(true).open(&target)?;
                return Ok(Pending { file, temporary: None, target });
            }
            if found.permissions().readonly() {
                return refused(io::ErrorKind::PermissionDenied, "exists and is read-only");
            }
        }
        let (file, temporary) = create_beside(&target)?;
        let pending = Pending { file, temporary: Some(temporary), target };
        if let Some(found) = found {
            pending.file.set_permissions(found.permissions())?;
        }
        Ok(pending)
    }

    /// Flushes the bytes and gives the file its name.
    pub fn commit(mut self) -> io::Result<()> {
        let Some(temporary) = &self.temporary else {
            return self.file.flush();
        };
        self.file.sync_all()?;
        fs::rename(temporary, &self.target)?;
        self.temporary = None;
        flush_folder(&folder_of(&self.target));
        Ok(())
    }
}

impl Drop for Pending {
    fn drop(&mut self) {
        if let Some(temporary) = &self.temporary {
            let _ = fs::remove_file(temporary);
        }
    }
}

impl Write for Pending {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for Pending {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.file.seek(position)
    }
}

/// Writes a whole small file.
pub fn write(target: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut pending = Pending::create(target)?;
    pending.write_all(bytes)?;
    pending.commit()
}

fn folder_of(target: &Path) -> PathBuf {
    match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_path_buf(),
        _ => PathBuf::from("."),
    }
}

/// A new file beside `target`, with the permissions that a new `target` would get.
fn create_beside(target: &Path) -> io::Result<(File, PathBuf)> {
    static NEXT: AtomicU32 = AtomicU32::new(0);
    let name =
        target.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "has no name"))?;
    // file names end at 255 bytes: leave room for what is added
    let name: String = name.to_string_lossy().chars().take(50).collect();
    loop {
        let n = NEXT.fetch_add(1, Ordering::Relaxed);
        let temporary = folder_of(target).join(format!(".{name}.tmp-{}-{n}", std::process::id()));
        match OpenOptions::new().write(true).create_new(true).open(&temporary) {
            Ok(file) => return Ok((file, temporary)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
}

/// Makes the new name durable, where the system can; the file is complete either way.
fn flush_folder(folder: &Path) {
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("the test's folder");
        entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn the_old_file_stays_until_the_new_one_is_whole() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let target = folder.path().join("out.exr");
        write(&target, b"old").expect("written");
        let mut pending = Pending::create(&target).expect("created");
        pending.write_all(b"half").expect("written");
        assert_eq!(fs::read(&target).ok(), Some(b"old".to_vec()));
        drop(pending);
        assert_eq!(fs::read(&target).ok(), Some(b"old".to_vec()));
        assert_eq!(names(folder.path()), ["out.exr"]);
        write(&target, b"new").expect("written");
        assert_eq!(fs::read(&target).ok(), Some(b"new".to_vec()));
        assert_eq!(names(folder.path()), ["out.exr"]);
    }

    #[test]
    fn a_target_that_cannot_be_written_is_refused_before_anything_is_written() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let kind = |path: &Path| probe(path).map_err(|error| error.kind());
        assert_eq!(kind(&folder.path().join("missing/out.exr")), Err(io::ErrorKind::NotFound));
        assert_eq!(kind(folder.path()), Err(io::ErrorKind::IsADirectory));
        let locked = folder.path().join("locked.exr");
        fs::write(&locked, b"kept").expect("written");
        let mut permissions = fs::metadata(&locked).expect("there").permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&locked, permissions).expect("set");
        assert_eq!(kind(&locked), Err(io::ErrorKind::PermissionDenied));
        assert_eq!(kind(&folder.path().join("fine.exr")), Ok(()));
        assert_eq!(names(folder.path()), ["locked.exr"]);
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_devices_stay_devices() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let (real, link) = (folder.path().join("real.exr"), folder.path().join("link.exr"));
        fs::write(&real, b"old").expect("written");
        std::os::unix::fs::symlink(&real, &link).expect("linked");
        write(&link, b"new").expect("written");
        assert!(link.is_symlink());
        assert_eq!(fs::read(&real).ok(), Some(b"new".to_vec()));
        write(Path::new("/dev/null"), b"gone").expect("written");
        assert!(!fs::metadata("/dev/null").expect("there").is_file());
    }
}
