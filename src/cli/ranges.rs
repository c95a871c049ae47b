//! Lists of numbers as engines write them: `0-3,6,10-20:2`.

/// The numbers of a list in the order in which they stand there, each as often as it does; of at least `least`, and
/// at most `most` of them.
pub fn numbers(text: &str, least: u32, most: usize) -> Result<Vec<u32>, String> {
    let mut list = Vec::new();
    for part in text.split(',') {
        let number = |text: &str| {
            let text = text.trim();
            let digits = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
            text.parse::<u32>().map_err(|_| match digits {
                true => format!("`{part}`: numbers end with {}", u32::MAX),
                false => format!("`{part}` is neither a number (7) nor a range (1-48, 1-48:2)"),
            })
        };
        let (range, step) = match part.split_once(':') {
            Some((range, step)) => (range, number(step)?),
            None => (part, 1),
        };
        let (first, last) = match range.split_once('-') {
            Some((first, last)) => (number(first)?, number(last)?),
            None => (number(range)?, number(range)?),
        };
        if step == 0 {
            return Err(format!("`{part}`: a step is 1 or more"));
        }
        if first > last {
            return Err(format!("`{part}`: the first number is behind the last"));
        }
        if first < least {
            return Err(format!("`{part}`: numbers begin with {least}"));
        }
        if list.len() + ((last - first) / step) as usize >= most {
            return Err(format!("more than {most} numbers"));
        }
        list.extend((first..=last).step_by(step as usize));
    }
    Ok(list)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_numbers_are_those_of_engines() {
        assert_eq!(numbers("0-0", 0, 9), Ok(vec![0]));
        assert_eq!(numbers("1-3,5, 7-12:2,2", 1, 9), Ok(vec![1, 2, 3, 5, 7, 9, 11, 2]));
        for wrong in ["", "a", "3-1", "1-", "1-3:0", "-1", "1,,2", "0", "1-4294967295", "1-10", "1.5"] {
            assert!(numbers(wrong, 1, 9).is_err(), "{wrong}");
        }
        assert_eq!(
            numbers("1-99999999999", 1, 9),
            Err("`1-99999999999`: numbers end with 4294967295".to_owned())
        );
    }
}
