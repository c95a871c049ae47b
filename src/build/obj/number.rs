//! Numbers out of bytes, correctly rounded.
//!
//! A decimal of up to 15 digits or so is an integer below 2⁵³ times or over a power of ten up to
//! 10²², both exact in double precision, so that one rounding gives the nearest double (Clinger 1990).
//! Everything else goes to the standard library. Both give the same bits.

const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// Whether the byte separates words within a line.
#[inline]
pub(super) fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | 0x0b | 0x0c)
}

/// The number that the word at the start of `text` spells, and the word's length. A word ends at a
/// blank, a line feed or the end. `None` when it is not a number.
#[inline]
pub(super) fn float(text: &[u8]) -> Option<(f64, usize)> {
    let mut at = usize::from(matches!(text.first(), Some(b'-' | b'+')));
    let start = at;
    let mut mantissa = 0u64;
    at += digits(&text[at..], &mut mantissa);
    let mut used = at - start;
    let mut exponent = 0i32;
    if text.get(at) == Some(&b'.') {
        let n = digits(&text[at + 1..], &mut mantissa);
        at += 1 + n;
        used += n;
        exponent = -(n as i32);
    }
    if let Some(b'e' | b'E') = text.get(at)
        && let Some((power, n)) = small_exponent(&text[at + 1..])
    {
        exponent += power;
        at += 1 + n;
    }
    let ended = text.get(at).is_none_or(|&byte| byte == b'\n' || is_blank(byte));
    // 19 digits cannot overflow 64 bits.
    let exact = used > 0 && used <= 19 && mantissa <= 1 << 53 && exponent.unsigned_abs() <= 22;
    if !(ended && exact) {
        return by_library(text);
    }
    let power = POWERS[exponent.unsigned_abs() as usize];
    let size = if exponent < 0 { mantissa as f64 / power } else { mantissa as f64 * power };
    Some((if text[0] == b'-' { -size } else { size }, at))
}

#[inline]
fn digits(text: &[u8], value: &mut u64) -> usize {
    let mut n = 0;
    while let Some(digit) = text.get(n).map(|byte| byte.wrapping_sub(b'0'))
        && digit < 10
    {
        *value = value.wrapping_mul(10).wrapping_add(digit as u64);
        n += 1;
    }
    n
}

fn small_exponent(text: &[u8]) -> Option<(i32, usize)> {
    let sign = usize::from(matches!(text.first(), Some(b'-' | b'+')));
    let mut value = 0;
    let n = digits(&text[sign..], &mut value);
    if n == 0 || n > 4 {
        return None;
    }
    let value = value as i32;
    Some((if text[0] == b'-' { -value } else { value }, sign + n))
}

#[cold]
fn by_library(text: &[u8]) -> Option<(f64, usize)> {
    let end = text.iter().position(|&byte| byte == b'\n' || is_blank(byte)).unwrap_or(text.len());
    let value = std::str::from_utf8(&text[..end]).ok()?.parse().ok()?;
    Some((value, end))
}

/// The index, counted from 0, that the digits at the start of `text` spell counted from 1, and how
/// many digits there are. `None` when there are none, for 0, and from 2³² − 1 on.
#[inline]
pub(super) fn index(text: &[u8]) -> Option<(u32, usize)> {
    let mut value = 0;
    let n = digits(text, &mut value);
    // The largest is kept for a missing index; leading zeros are left to the other reading.
    (n <= 10 && value > 0 && value < u32::MAX as u64).then(|| (value as u32 - 1, n))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_float_has_the_bits_that_the_standard_library_gives_it() {
        let mut state = 1u64;
        let mut next = |n: u64| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) % n
        };
        for _ in 0..200_000 {
            let whole = (0..next(12)).map(|_| (b'0' + next(10) as u8) as char).collect::<String>();
            let part = (0..next(12)).map(|_| (b'0' + next(10) as u8) as char).collect::<String>();
            let sign = ["", "-", "+"][next(3) as usize];
            let dot = ["", "."][next(2) as usize];
            let power = match next(4) {
                0 => format!("e{}", next(700) as i64 - 350),
                1 => format!("E+{}", next(30)),
                _ => String::new(),
            };
            let word = format!("{sign}{whole}{dot}{part}{power}");
            let (want, got) = (word.parse::<f64>().ok(), float(format!("{word} 7").as_bytes()));
            assert_eq!(want.map(f64::to_bits), got.map(|(x, _)| x.to_bits()), "{word}");
            assert!(got.is_none_or(|(_, length)| length == word.len()), "{word}");
        }
    }

    #[test]
    fn a_float_may_be_infinite_but_no_word_around_it_is_let_through() {
        assert_eq!(float(b"-inf").unwrap().0, f64::NEG_INFINITY);
        assert_eq!(float(b"1e999\n").unwrap().0, f64::INFINITY);
        for bad in ["", "-", ".", "1x", "0x10", "1e", "1e+", "--1", "1.2.3", "1/2", "1_0", "١"] {
            assert!(float(bad.as_bytes()).is_none(), "{bad}");
        }
    }

    #[test]
    fn an_index_counts_from_one_in_the_file() {
        assert_eq!(index(b"12/3"), Some((11, 2)));
        for bad in ["0", "-1", "", "4294967295", "99999999999", "18446744073709551617"] {
            assert_eq!(index(bad.as_bytes()), None, "{bad}");
        }
    }
}
