//! Which brackets of a RON text belong together, found without its grammar: where reading can go on
//! after an error.

/// The lists and maps whose brackets match.
pub(super) struct Brackets {
    /// Opening and closing brackets, byte offsets, in the order of the opening ones.
    pairs: Vec<(usize, usize)>,
    /// Each comma with the bracket that it stands in, in the order of the text.
    commas: Vec<(usize, usize)>,
}

impl Brackets {
    pub fn of(text: &str) -> Brackets {
        let bytes = text.as_bytes();
        let mut found = Brackets { pairs: Vec::new(), commas: Vec::new() };
        let mut open: Vec<usize> = Vec::new();
        let mut at = 0;
        while let Some(&byte) = bytes.get(at) {
            match byte {
                b'/' | b'"' | b'\'' | b'r' => {
                    at = after_opaque(bytes, at).max(at + 1);
                    continue;
                }
                b'(' | b'[' | b'{' => open.push(at),
                b')' | b']' | b'}' => match open.pop() {
                    Some(start) if pair(bytes[start]) == byte => found.pairs.push((start, at)),
                    // One is missing or too many: none of those around can be trusted.
                    _ => open.clear(),
                },
                b',' => found.commas.extend(open.last().map(|start| (at, *start))),
                _ => {}
            }
            at += 1;
        }
        found.pairs.sort_unstable();
        found
    }

    fn close(&self, open: usize) -> Option<usize> {
        let at = self.pairs.binary_search_by_key(&open, |(start, _)| *start).ok()?;
        Some(self.pairs[at].1)
    }

    /// Behind the first comma from byte `from` on that stands directly in the bracket at `open`, or
    /// before that bracket's end. None if the bracket is not closed.
    pub fn resume(&self, open: usize, from: usize) -> Option<usize> {
        let close = self.close(open)?;
        if from > close {
            return None;
        }
        let first = self.commas.partition_point(|(at, _)| *at < from);
        let comma = self.commas[first..]
            .iter()
            .take_while(|(at, _)| *at < close)
            .find(|(_, within)| *within == open)
            .map(|(at, _)| at + 1);
        Some(comma.unwrap_or(close))
    }
}

fn pair(open: u8) -> u8 {
    match open {
        b'(' => b')',
        b'[' => b']',
        _ => b'}',
    }
}

/// Where the text, character or comment that begins at `at` ends; `at` itself if none does.
fn after_opaque(bytes: &[u8], at: usize) -> usize {
    let rest = &bytes[at..];
    let find = |what: &[u8], from: usize| {
        let found = rest.get(from..).and_then(|rest| rest.windows(what.len()).position(|w| w == what));
        found.map_or(bytes.len(), |i| at + from + i + what.len())
    };
    match rest[0] {
        b'/' if rest.starts_with(b"//") => find(b"\n", 2),
        b'/' if rest.starts_with(b"/*") => after_block_comment(bytes, at),
        b'"' | b'\'' => after_quoted(bytes, at),
        b'r' if at == 0 || !is_word(bytes[at - 1]) => {
            let hashes = rest[1..].iter().take_while(|byte| **byte == b'#').count();
            if rest.get(1 + hashes) != Some(&b'"') {
                return at;
            }
            let mut close = vec![b'"'];
            close.resize(1 + hashes, b'#');
            find(&close, 2 + hashes)
        }
        _ => at,
    }
}

fn after_quoted(bytes: &[u8], at: usize) -> usize {
    let mut i = at + 1;
    while let Some(&byte) = bytes.get(i) {
        i += if byte == b'\\' { 2 } else { 1 };
        if byte == bytes[at] {
            return i;
        }
    }
    bytes.len()
}

fn after_block_comment(bytes: &[u8], at: usize) -> usize {
    let (mut i, mut open) = (at, 0);
    while i < bytes.len() {
        if bytes[i..].starts_with(b"/*") {
            (i, open) = (i + 2, open + 1);
        } else if bytes[i..].starts_with(b"*/") {
            (i, open) = (i + 2, open - 1);
        } else {
            i += 1;
        }
        if open == 0 {
            return i;
        }
    }
    bytes.len()
}

fn is_word(byte: u8) -> bool {
    byte == b'_' || byte.is_ascii_alphanumeric() || !byte.is_ascii()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brackets_in_texts_and_comments_are_not_brackets() {
        let text = r##"( ")" , /* ) /* ] */ ) */ '(' , r#"")"# , // )
        [ 1, 2 ], x )"##;
        let brackets = Brackets::of(text);
        assert_eq!(brackets.close(0), Some(text.len() - 1));
        assert_eq!(brackets.pairs.len(), 2);
        assert_eq!(brackets.commas.iter().filter(|(_, open)| *open == 0).count(), 4);
    }

    #[test]
    fn reading_goes_on_behind_a_comma_of_the_same_list() {
        let text = "(a [b, c], d)";
        let brackets = Brackets::of(text);
        assert_eq!(brackets.resume(0, 1), Some(10));
        assert_eq!(brackets.resume(3, 4), Some(6));
        assert_eq!(brackets.resume(0, 10), Some(12));
    }

    #[test]
    fn what_is_not_closed_gives_no_place_to_go_on() {
        let brackets = Brackets::of("([(1, 2), (3}, 4])");
        assert_eq!(brackets.resume(2, 3), Some(5));
        assert_eq!(brackets.resume(1, 3), None);
        assert_eq!(brackets.resume(0, 3), None);
    }
}
