//! Which files a scene may read: those of its own folder and of folders that the caller names.
//!
//! A scene is other people's text. It must not make the program read what its user did not mean to
//! show it, or wait for what never comes. So a file is opened here and nowhere else: asked first
//! whether it is a regular file, opened without waiting, and then judged by where the opened file
//! really lies, so that links that are moved about meanwhile change nothing.

use std::fs::{self, File};
use std::io;
use std::path::{Component, Path, PathBuf};

/// A folder that holds a file of this name is a project: scenes below it may read all of it.
pub const PROJECT_MARK: &str = ".terrarium-project";

/// The folders from which files may be read. By default, all of them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reach {
    /// Without links and dots; none is no bound.
    roots: Option<Vec<PathBuf>>,
}

impl Reach {
    /// A scene's own folder, or the nearest folder around it that bears the mark of a project, and
    /// what else is allowed.
    ///
    /// # Errors
    /// One of the allowed folders is not there, with its path. A scene's folder that is not there
    /// lets nothing be read.
    pub fn within(folder: &Path, allowed: &[PathBuf]) -> Result<Reach, (PathBuf, io::Error)> {
        let own = here(folder).canonicalize().ok();
        let project = |folder: &&Path| folder.join(PROJECT_MARK).is_file();
        let mut roots: Vec<PathBuf> =
            own.iter().map(|own| own.ancestors().find(project).unwrap_or(own).to_owned()).collect();
        for folder in allowed {
            let canonical = here(folder).canonicalize().and_then(|found| match found.is_dir() {
                true => Ok(found),
                false => Err(io::Error::new(io::ErrorKind::NotADirectory, "it is not a folder")),
            });
            roots.push(canonical.map_err(|error| (folder.clone(), error))?);
        }
        Ok(Reach { roots: Some(roots) })
    }

    /// Adds a folder whose files are the program's own. One that is not there adds nothing.
    pub fn allow(&mut self, folder: &Path) {
        if let (Some(roots), Ok(folder)) = (&mut self.roots, here(folder).canonicalize()) {
            roots.push(folder);
        }
    }

    /// Opens a regular file within reach.
    ///
    /// # Errors
    /// As the system has them; `PermissionDenied` for a file out of reach, whether it is there or not.
    pub fn open(&self, path: &Path) -> io::Result<File> {
        if !self.allows(&destination(path)) {
            return Err(self.refused());
        }
        let about = fs::metadata(path).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => io::Error::new(error.kind(), "there is no such file"),
            _ => error,
        })?;
        regular(&about)?;
        let file = without_waiting().read(true).open(path)?;
        regular(&file.metadata()?)?;
        if self.roots.is_some() && !self.allows(&place(&file, path)?) {
            return Err(self.refused());
        }
        Ok(file)
    }

    fn allows(&self, path: &Path) -> bool {
        self.roots.as_ref().is_none_or(|roots| roots.iter().any(|root| path.starts_with(root)))
    }

    fn refused(&self) -> io::Error {
        let roots: Vec<String> =
            self.roots.iter().flatten().map(|root| format!("`{}`", root.display())).collect();
        let message = format!(
            "it lies outside {}; `--allow` with its folder lets the scene read it",
            if roots.is_empty() { "every folder".to_owned() } else { roots.join(" and ") }
        );
        io::Error::new(io::ErrorKind::PermissionDenied, message)
    }
}

/// The empty path is the current folder.
fn here(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

/// Where a path leads: links are followed as far as it is there, and what is not there is taken by its name.
fn destination(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut known = path.as_path();
    let mut real = loop {
        match (known.canonicalize(), known.parent()) {
            (Ok(real), _) => break real,
            (Err(_), Some(parent)) => known = parent,
            (Err(_), None) => break known.to_owned(),
        }
    };
    for part in path.strip_prefix(known).unwrap_or(Path::new("")).components() {
        match part {
            Component::ParentDir => drop(real.pop()),
            Component::Normal(name) => real.push(name),
            _ => {}
        }
    }
    real
}

fn regular(about: &fs::Metadata) -> io::Result<()> {
    if about.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder"));
    }
    if !about.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is not a regular file"));
    }
    Ok(())
}

/// A pipe that takes the file's place after it was looked at is opened at once and refused then.
#[cfg(target_os = "linux")]
fn without_waiting() -> fs::OpenOptions {
    use std::os::unix::fs::OpenOptionsExt;
    const O_NONBLOCK: i32 = 0o4000;
    let mut options = File::options();
    if cfg!(any(target_arch = "x86_64", target_arch = "aarch64", target_arch = "riscv64")) {
        options.custom_flags(O_NONBLOCK);
    }
    options
}

#[cfg(not(target_os = "linux"))]
fn without_waiting() -> fs::OpenOptions {
    File::options()
}

/// Where an opened file lies.
fn place(file: &File, path: &Path) -> io::Result<PathBuf> {
    #[cfg(target_os = "linux")]
    {
        use std::os::fd::AsRawFd;
        if let Ok(place) = fs::read_link(format!("/proc/self/fd/{}", file.as_raw_fd())) {
            return Ok(place);
        }
    }
    let _ = file;
    path.canonicalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_there_is_judged_by_its_name() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let real = folder.path().canonicalize().expect("it is there");
        for (path, expected) in [("a", "a"), ("a/../b", "b"), ("a/b/../../c", "c"), ("./a", "a")] {
            assert_eq!(destination(&real.join(path)), real.join(expected), "{path}");
        }
        let outside = destination(&real.join("a/../../b"));
        assert_eq!(Some(outside.as_path()), real.parent().map(|parent| parent.join("b")).as_deref());
    }

    #[test]
    fn the_nearest_project_around_a_scene_is_its_reach() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let deep = folder.path().join("project/scenes/deep");
        fs::create_dir_all(&deep).expect("made");
        let open = |path: &str| Reach::within(&deep, &[]).expect("no folders").open(&deep.join(path)).is_ok();
        fs::write(folder.path().join("secret"), "").expect("written");
        fs::write(folder.path().join("project/asset"), "").expect("written");
        fs::write(deep.join("own"), "").expect("written");
        assert_eq!((open("own"), open("../../asset"), open("../../../secret")), (true, false, false));
        fs::write(folder.path().join("project").join(PROJECT_MARK), "").expect("written");
        assert_eq!((open("own"), open("../../asset"), open("../../../secret")), (true, true, false));
    }
}
