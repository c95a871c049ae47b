//! Letters as strokes, for pictures that no font renderer draws. Our own, on a grid of 5 × 9: capitals from
//! the base line (0) to 6, small letters to 4, tails down to −2.

/// A stroke's corners in grid units, y upwards from the base line.
pub type Stroke = Vec<[f64; 2]>;

/// Height of a capital in grid units, and the room between letters.
pub const CAPITAL: f64 = 6.0;
const GAP: f64 = 2.0;

/// A line a letter: the letter, then its strokes. A corner is x and y; y may be `a` (−1) or `b` (−2).
const LETTERS: &str = "\
0 100105163645413010
1 042620 0040
2 05163645440040
3 0516364544332313 334241301001
4 30360242
5 46060434434130 301001
6 453616050110304142331302
7 064610
8 130405163645443313 1302011030414233
9 443313040516364541301001
A 002640 1232
B 0006364544330333 3342413000
C 4536160501103041
D 00062644422000
E 46060040 0333
F 460600 0333
G 4536160501103041 414323
H 0006 4046 0343
I 0006
J 4641301001
K 0600 460340
L 060040
M 0006234640
N 00064046
O 100105163645413010
P 00063645443303
Q 100105163645413010 2240
R 00063645443303 2340
S 453616050413334241301001
T 0646 2026
U 060110304146
V 062046
W 0610243046
X 0640 0046
Y 062346 2320
Z 06460040
a 433414030110304143 4440
b 0600 031434434130100103
c 4334140301103041
d 4640 433414030110304143
e 02424334140301103041
f 36261510 0434
g 444a3b1b0a 433414030110304143
h 0600 0314344340
i 0004 0606
j 141a0b 1616
k 0600 340230
l 061120
m 0004 0314232023 23344340
n 0004 0314344340
o 10010314344341301001
p 0b04 031434434130100103
q 4b44 433414030110304143
r 0004 031434
s 43341403123241301001
t 16112030 0434
u 0401103041 4440
v 042044
w 0410233044
x 0440 0044
y 0420 441b0b
z 04440040
. 0000
, 100a
: 0000 0404
; 0404 100a
( 16050110
) 06151100
[ 16060010
] 06161000
% 0046 0616150506 3040413130
- 0333
+ 0343 2125
= 0242 0444
× 0145 0541
− 0242
/ 0046
_ 0a4a
² 061625041424
< 450341
> 054301
· 0303
' 0605
";

/// The strokes of a text that begins at the origin, and its width. Letters that are not known are boxes.
pub fn strokes(text: &str) -> (Vec<Stroke>, f64) {
    let (mut strokes, mut pen) = (Vec::new(), 0.0);
    for letter in text.chars() {
        if letter == ' ' || letter == '\u{a0}' {
            pen += 3.0;
            continue;
        }
        let own = of(letter);
        let width = own.iter().flatten().map(|p| p[0]).fold(0.0, f64::max);
        strokes.extend(own.into_iter().map(|s| s.into_iter().map(|[x, y]| [x + pen, y]).collect()));
        pen += width + GAP;
    }
    (strokes, (pen - GAP).max(0.0))
}

fn of(letter: char) -> Vec<Stroke> {
    let known = LETTERS.lines().find_map(|line| line.strip_prefix(letter)?.strip_prefix(' '));
    known.unwrap_or("0006464000").split(' ').map(corners).collect()
}

fn corners(stroke: &str) -> Stroke {
    let number = |c: u8| match c {
        b'a' => -1.0,
        b'b' => -2.0,
        digit => f64::from(digit.saturating_sub(b'0')),
    };
    stroke.as_bytes().chunks_exact(2).map(|pair| [number(pair[0]), number(pair[1])]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_letter_lies_on_the_grid_and_looks_like_no_other() {
        let mut seen: Vec<(char, Vec<Stroke>)> = Vec::new();
        for line in LETTERS.lines() {
            let letter = line.chars().next().expect("a letter");
            let strokes = line.chars().skip(2).collect::<String>();
            for stroke in strokes.split(' ') {
                assert!(stroke.len() >= 4 && stroke.len() % 2 == 0, "{letter}: {stroke}");
            }
            let own = of(letter);
            for [x, y] in own.iter().flatten() {
                assert!((0.0..=4.0).contains(x) && (-2.0..=6.0).contains(y), "{letter}: {x} {y}");
            }
            let twin = seen.iter().find(|(other, strokes)| *strokes == own && (*other, letter) != ('0', 'O'));
            assert!(twin.is_none(), "{letter} looks like {twin:?}");
            seen.push((letter, own));
        }
        let all = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz.,:;()[]%-+=×−/_²<>·'";
        assert!(all.chars().all(|letter| seen.iter().any(|(known, _)| *known == letter)));
        assert_eq!(strokes("").1, 0.0);
        assert_eq!(strokes("II").1, 2.0);
    }
}
