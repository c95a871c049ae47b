//! An OBJ file in canonical form, line by line as it is read, so that `tobj` meets only what it
//! reads well and every mistake is found here, with its line.
//!
//! - Byte order mark, comments, carriage returns and line continuations are gone.
//! - `v` has three finite coordinates (divided by the fourth, if there is one) and, as a colour, its
//!   own number: `tobj` drops unused positions and splits them by group, and this tells which is which.
//! - Each corner is v/vt/vn with positive indices. `vt` 1 and `vn` 1 are put in front to mean
//!   "missing", because `tobj` would repeat the corner before.
//! - A change of group or material is `g` and the part's number. Names never reach `tobj`.

use super::number::{float, is_blank};
use super::{Fault, Notes, PartName, direction};
use crate::math::Vec3;
use std::collections::HashMap;
use std::io::{self, BufRead, Read, Write};

/// A line longer than this is no text.
const MAX_LINE_BYTES: usize = 16 << 20;

/// The file as `tobj` shall see it.
pub(super) struct Canonical<R> {
    source: R,
    raw: Vec<u8>,
    out: Vec<u8>,
    /// How much of `out` has been taken.
    taken: usize,
    /// Lines read.
    pub(super) lines: u64,
    /// Line at which the current statement begins.
    pub(super) line: u64,
    /// So far, of v, vt, vn.
    pub(super) counts: [u64; 3],
    /// Largest index beyond the count of its time, and its line, of v, vt, vn.
    ahead: [(u64, u64); 3],
    pub(super) faces: u64,
    name: PartName,
    /// The part that `tobj` was told last.
    told: Option<u32>,
    known: HashMap<PartName, u32>,
    pub(super) part_names: Vec<PartName>,
    pub(super) notes: Notes,
    /// Why the reading stopped.
    pub(super) fault: Option<Fault>,
}

type Checked<T> = Result<T, String>;

impl<R: BufRead> Canonical<R> {
    pub(super) fn new(source: R) -> Self {
        Canonical {
            source,
            raw: Vec::new(),
            out: b"vt nan nan\nvn nan nan nan\n".to_vec(),
            taken: 0,
            lines: 0,
            line: 0,
            counts: [0; 3],
            ahead: [(0, 0); 3],
            faces: 0,
            name: PartName::default(),
            told: None,
            known: HashMap::new(),
            part_names: Vec::new(),
            notes: Notes::default(),
            fault: None,
        }
    }

    /// One statement more, as a line or none; false at the end.
    fn advance(&mut self) -> Result<bool, Fault> {
        self.out.clear();
        self.taken = 0;
        if !self.read_statement()? {
            return self.check_ahead().map(|()| false);
        }
        let raw = std::mem::take(&mut self.raw);
        let done = self.statement(&raw);
        self.raw = raw;
        done.map(|()| true).map_err(|message| Fault::Invalid(Some(self.line), message))
    }

    /// Reads a line and those that continue it; false at the end.
    fn read_statement(&mut self) -> Result<bool, Fault> {
        self.raw.clear();
        self.line = self.lines + 1;
        loop {
            let room = (MAX_LINE_BYTES - self.raw.len()) as u64;
            if self.source.by_ref().take(room).read_until(b'\n', &mut self.raw)? == 0 {
                return Ok(!self.raw.is_empty());
            }
            self.lines += 1;
            if self.lines == 1 && self.raw.starts_with(b"\xef\xbb\xbf") {
                self.raw.drain(..3);
            }
            if self.raw.len() == MAX_LINE_BYTES {
                let message = format!("is longer than {} MiB", MAX_LINE_BYTES >> 20);
                return Err(Fault::NotSupported(Some(self.line), message));
            }
            let text = self.raw.trim_ascii_end();
            if !text.ends_with(b"\\") || without_comment(text) != text {
                return Ok(true);
            }
            let end = text.len() - 1;
            self.raw.truncate(end);
            self.raw.push(b' ');
        }
    }

    fn statement(&mut self, raw: &[u8]) -> Checked<()> {
        if raw.contains(&0) {
            return Err("is not text".into());
        }
        let text = without_comment(raw);
        let mut words = text.split(|&byte| is_blank(byte) || byte == b'\n').filter(|word| !word.is_empty());
        let Some(keyword) = words.next() else { return Ok(()) };
        match keyword {
            b"v" => self.position(words),
            b"vt" => self.uv(words),
            b"vn" => self.normal(words),
            b"f" => self.face(words),
            b"g" | b"o" => self.rename(text, |name| &mut name.group),
            b"usemtl" => self.rename(text, |name| &mut name.material),
            b"s" => {
                self.notes.smoothing(text.trim_ascii()[1..].trim_ascii());
                Ok(())
            }
            b"mtllib" => Ok(()),
            other => {
                self.notes.ignored += 1;
                self.notes.first_ignored.get_or_insert_with(|| (self.line, quote(other)));
                Ok(())
            }
        }
    }

    fn rename(&mut self, text: &[u8], slot: impl Fn(&mut PartName) -> &mut String) -> Checked<()> {
        let text = text.trim_ascii();
        let word = text.iter().position(|&byte| is_blank(byte)).unwrap_or(text.len());
        *slot(&mut self.name) = String::from_utf8_lossy(text[word..].trim_ascii()).into_owned();
        Ok(())
    }

    fn position<'a>(&mut self, words: impl Iterator<Item = &'a [u8]> + Clone) -> Checked<()> {
        let values = numbers(words.clone(), "a position", 3, 7)?;
        let divisor = if matches!(values.len(), 4 | 7) { values[3] } else { 1.0 };
        let at = [0, 1, 2].map(|k| values[k] / divisor);
        if divisor == 0.0 || !at.iter().all(|x| x.is_finite()) {
            return Err("a position is not finite".into());
        }
        let number = self.counts[0];
        self.counts[0] += 1;
        if divisor != 1.0 {
            return self.write(format_args!("v {:e} {:e} {:e} {number} 0 0\n", at[0], at[1], at[2]));
        }
        self.copy(b"v", words.take(3));
        self.write(format_args!(" {number} 0 0\n"))
    }

    fn uv<'a>(&mut self, words: impl Iterator<Item = &'a [u8]> + Clone) -> Checked<()> {
        let values = numbers(words, "a texture coordinate", 1, 3)?;
        let uv = [values[0], values.get(1).copied().unwrap_or(0.0)];
        self.counts[1] += 1;
        if uv.iter().all(|&x| (x as f32).is_finite()) {
            return self.write(format_args!("vt {:e} {:e}\n", uv[0], uv[1]));
        }
        self.notes.bad_uvs += 1;
        self.write(format_args!("vt 0 0\n"))
    }

    fn normal<'a>(&mut self, words: impl Iterator<Item = &'a [u8]> + Clone) -> Checked<()> {
        let values = numbers(words.clone(), "a normal", 3, 3)?;
        let [x, y, z] = [values[0], values[1], values[2]];
        self.counts[2] += 1;
        if direction([x, y, z]) != Vec3::ZERO {
            self.copy(b"vn", words);
            return self.write(format_args!("\n"));
        }
        self.notes.bad_normals += 1;
        self.write(format_args!("vn 0 0 0\n"))
    }

    fn face<'a>(&mut self, words: impl Iterator<Item = &'a [u8]> + Clone) -> Checked<()> {
        self.tell_part()?;
        self.write(format_args!("f"))?;
        let mut corners = 0;
        for word in words {
            let [v, vt, vn] = self.corner(word)?;
            let v = v.ok_or_else(|| format!("corner `{}` has no position", quote(word)))?;
            let (vt, vn) = (vt.map_or(1, |i| i + 1), vn.map_or(1, |i| i + 1));
            self.write(format_args!(" {v}/{vt}/{vn}"))?;
            corners += 1;
        }
        if corners < 3 {
            return Err(format!("a face needs 3 corners or more, and this one has {corners}"));
        }
        self.faces += 1;
        self.write(format_args!("\n"))
    }

    /// The indices of v, v/vt, v//vn or v/vt/vn, counted from 1.
    fn corner(&mut self, word: &[u8]) -> Checked<[Option<u64>; 3]> {
        let mut found = [None; 3];
        for (k, index) in word.split(|&byte| byte == b'/').enumerate() {
            let wrong = || format!("`{}` is not a corner: expected v, v/vt, v//vn or v/vt/vn", quote(word));
            if k == 3 {
                return Err(wrong());
            }
            if !index.is_empty() {
                let is_number = index.strip_prefix(b"-").unwrap_or(index).iter().all(u8::is_ascii_digit);
                let value =
                    is_number.then(|| std::str::from_utf8(index).ok()?.parse::<i128>().ok()).flatten();
                // Only digits, yet no number: beyond any range.
                let value = value.or((is_number && index.len() > 30).then_some(i128::MAX));
                found[k] = Some(self.resolve(k, value.ok_or_else(wrong)?)?);
            }
        }
        Ok(found)
    }

    /// An index as the file has it, negative ones from the end, to one counted from 1.
    fn resolve(&mut self, k: usize, index: i128) -> Checked<u64> {
        let (kind, count) = (["v", "vt", "vn"][k], self.counts[k]);
        let resolved = if index < 0 { count as i128 + 1 + index } else { index };
        if index == 0 {
            return Err(format!("index 0 of `{kind}`: indices count from 1"));
        }
        if resolved < 1 || resolved >= u32::MAX as i128 {
            return Err(format!("index {index} is out of range: there are {count} `{kind}` before it"));
        }
        let resolved = resolved as u64;
        if resolved > count && resolved > self.ahead[k].0 {
            self.ahead[k] = (resolved, self.line);
        }
        Ok(resolved)
    }

    /// Indices may point ahead, but not beyond the end.
    fn check_ahead(&self) -> Result<(), Fault> {
        for ((kind, count), (index, line)) in ["v", "vt", "vn"].iter().zip(self.counts).zip(self.ahead) {
            if index > count {
                let message = format!("index {index} is out of range: the file has {count} `{kind}`");
                return Err(Fault::Invalid(Some(line), message));
            }
        }
        Ok(())
    }

    fn tell_part(&mut self) -> Checked<()> {
        let part = match self.known.get(&self.name) {
            Some(&part) => part,
            None => {
                let part = self.part_names.len() as u32;
                self.known.insert(self.name.clone(), part);
                self.part_names.push(self.name.clone());
                part
            }
        };
        if self.told.replace(part) != Some(part) {
            self.write(format_args!("g {part}\n"))?;
        }
        Ok(())
    }

    /// The words as they are: as numbers, they have been checked.
    fn copy<'a>(&mut self, keyword: &[u8], words: impl Iterator<Item = &'a [u8]>) {
        self.out.extend_from_slice(keyword);
        for word in words {
            self.out.push(b' ');
            self.out.extend_from_slice(word);
        }
    }

    fn write(&mut self, text: std::fmt::Arguments) -> Checked<()> {
        self.out.write_fmt(text).map_err(|error| error.to_string())
    }
}

/// A comment begins with a `#` that begins a word.
fn without_comment(text: &[u8]) -> &[u8] {
    let begins = |&i: &usize| text[i] == b'#' && (i == 0 || is_blank(text[i - 1]));
    &text[..(0..text.len()).find(begins).unwrap_or(text.len())]
}

/// Between `least` and `most` numbers, and nothing else.
fn numbers<'a>(
    words: impl Iterator<Item = &'a [u8]>,
    what: &str,
    least: usize,
    most: usize,
) -> Checked<Vec<f64>> {
    let mut values = Vec::new();
    for word in words.take(most + 1) {
        let (value, _) = float(word).ok_or_else(|| format!("`{}` is not a number", quote(word)))?;
        values.push(value);
    }
    let n = values.len();
    if n < least {
        return Err(format!(
            "{what} needs {least} number{}, and this one has {n}",
            if least == 1 { "" } else { "s" }
        ));
    }
    if n > most {
        return Err(format!("{what} has at most {most} numbers"));
    }
    Ok(values)
}

/// A word of the file as it may stand in a message.
fn quote(word: &[u8]) -> String {
    let text = String::from_utf8_lossy(&word[..word.len().min(40)]).escape_debug().to_string();
    if word.len() > 40 { text + "…" } else { text }
}

impl<R: BufRead> Read for Canonical<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n = self.fill_buf()?.read(buffer)?;
        self.consume(n);
        Ok(n)
    }
}

/// One statement at a time, so that whatever `tobj` finds wrong is in the current one.
impl<R: BufRead> BufRead for Canonical<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        while self.taken == self.out.len() {
            match self.advance() {
                Ok(true) => {}
                Ok(false) => break,
                Err(fault) => {
                    self.fault = Some(fault);
                    return Err(io::Error::other("the file has a fault"));
                }
            }
        }
        Ok(&self.out[self.taken..])
    }

    fn consume(&mut self, n: usize) {
        self.taken += n;
    }
}
