//! Makes broken and hostile files out of good ones.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::Value;

/// Longest file that is made.
const LONGEST: usize = 1 << 20;

/// Numbers at the edge of what can be written, stored or meant.
const NUMBERS: &[&str] = &[
    "0",
    "-0",
    "0.0",
    "1",
    "-1",
    "2",
    "0.5",
    "1e-3",
    "1000",
    "1e6",
    "2e7",
    "2.0001e7",
    "1e9",
    "1e12",
    "1e18",
    "1e99",
    "1e300",
    "1e308",
    "1.8e308",
    "1e999",
    "-1e999",
    "1e-320",
    "5e-324",
    "nan",
    "NaN",
    "-nan",
    "inf",
    "-inf",
    "+inf",
    "infinity",
    "null",
    "true",
    "4294967295",
    "4294967296",
    "9007199254740993",
    "9223372036854775807",
    "18446744073709551615",
    "18446744073709551616",
    "-9223372036854775809",
    "1_000",
    "1__0",
    "0x10",
    "0b1",
    "1e",
    "1e+",
    ".5",
    "5.",
    "+5",
    "--5",
    "1,5",
    "1.000,5",
    "1 000",
    "1d5",
    "00",
    "1e400000000",
    "٣",
    "½",
    "1e-400",
    "3.4028236e38",
    "",
    "123456789012345678901234567890123456789012345678901234567890",
];

/// What separates, opens, closes or ends something in one of the formats.
const TOKENS: &[&str] = &[
    ",",
    ";",
    "\t",
    " ",
    "|",
    "\n",
    "\r\n",
    "\r",
    "\n\n",
    "\"",
    "\"\"",
    "'",
    "#",
    "=",
    ":",
    ".",
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    "(",
    ")",
    "\\",
    "\\n",
    "\\u0000",
    "\\ud800",
    "\0",
    "\u{feff}",
    "\u{1b}[2J",
    "\u{7f}",
    "\u{85}",
    "\u{2028}",
    "\u{202e}",
    "\u{fffd}",
    "é",
    "µ",
    "²",
    "Ω",
    "😀",
    "/",
    "//",
    "/*",
    "../",
    "-",
    "+",
    "%",
    "$",
    "~",
    "true",
    "false",
    "null",
    "\"\"\"",
    "'''",
    "1979-05-27T07:32:00Z",
];

/// What stands within a file, as far as edits care.
type Edit = fn(&mut Mutator, Vec<u8>) -> Vec<u8>;

/// Small edits, all of the same probability.
const EDITS: &[Edit] = &[
    Mutator::replace_number,
    Mutator::replace_number,
    Mutator::replace_number,
    Mutator::replace_word,
    Mutator::replace_word,
    Mutator::insert_token,
    Mutator::insert_token,
    Mutator::flip_byte,
    Mutator::remove_range,
    Mutator::repeat_range,
    Mutator::remove_line,
    Mutator::repeat_line,
    Mutator::swap_lines,
    Mutator::truncate,
];

/// Edits of a whole file, which are rare because they are slow to read.
const LARGE_EDITS: &[Edit] = &[
    Mutator::other_line_ends,
    Mutator::other_encoding,
    Mutator::other_separator,
    Mutator::huge_cell,
    Mutator::deep_nesting,
    Mutator::many_lines,
    Mutator::many_columns,
];

/// Draws mutations from the seed of a run.
pub struct Mutator {
    rng: ChaCha8Rng,
    /// Words of the format, from the files of its corpus.
    words: Vec<Vec<u8>>,
}

impl Mutator {
    /// - `corpus`: files of the format, from whose words new ones are made.
    pub fn new(seed: u64, corpus: &[Vec<u8>]) -> Self {
        let is_word = |byte: &u8| byte.is_ascii_alphanumeric() || b"_-.".contains(byte);
        let mut words: Vec<Vec<u8>> = corpus
            .iter()
            .flat_map(|file| file.split(|byte| !is_word(byte)))
            .filter(|word| !word.is_empty() && word.len() < 64)
            .map(<[u8]>::to_vec)
            .collect();
        words.sort();
        words.dedup();
        Self { rng: ChaCha8Rng::seed_from_u64(seed), words }
    }

    /// An index below `n`; 0 for an empty choice.
    pub fn below(&mut self, n: usize) -> usize {
        if n == 0 { 0 } else { self.rng.random_range(0..n) }
    }

    /// Whether something happens that does so once in `n` times.
    pub fn once_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    /// One of the numbers at the edge.
    pub fn number(&mut self) -> &'static str {
        NUMBERS[self.below(NUMBERS.len())]
    }

    /// Another text file.
    pub fn text(&mut self, input: &[u8], other: &[u8]) -> Vec<u8> {
        let mut out = if self.once_in(8) { self.spliced(input, other) } else { input.to_vec() };
        for _ in 0..=self.below(4) {
            let edit = EDITS[self.below(EDITS.len())];
            out = edit(self, out);
        }
        if self.once_in(200) {
            let edit = LARGE_EDITS[self.below(LARGE_EDITS.len())];
            out = edit(self, out);
        }
        out.truncate(LONGEST);
        out
    }

    /// Another JSON file: mostly still JSON, of which one value or a few are others.
    pub fn json(&mut self, input: &[u8], other: &[u8]) -> Vec<u8> {
        let parsed = if self.once_in(5) { None } else { serde_json::from_slice(input).ok() };
        let Some(mut value) = parsed else { return self.text(input, other) };
        for _ in 0..=self.below(3) {
            self.edit_json(&mut value);
        }
        let mut out = serde_json::to_vec(&value).expect("JSON can be written");
        if self.once_in(4) {
            // Numbers that JSON reads, but that no value of `serde_json` holds.
            out = self.replace_number(out);
        }
        out.truncate(LONGEST);
        out
    }

    /// Changes one value.
    pub fn edit_json(&mut self, value: &mut Value) {
        let mut at = self.below(n_nodes(value));
        let Some(node) = nth_node(value, &mut at) else { return };
        let number = self.number();
        match node {
            Value::Array(items) if !items.is_empty() && !self.once_in(8) => {
                let idx = self.below(items.len());
                match self.below(4) {
                    0 => drop(items.remove(idx)),
                    1 => items.clear(),
                    2 => items.push(items[idx].clone()),
                    _ => {
                        let n = if self.once_in(50) { 10_000 } else { 10 };
                        items.extend(vec![items[idx].clone(); n]);
                    }
                }
            }
            Value::Object(fields) if !fields.is_empty() && !self.once_in(8) => {
                let idx = self.below(fields.len());
                let key = fields.keys().nth(idx).cloned().unwrap_or_default();
                let taken = fields.remove(&key).unwrap_or_default();
                if self.once_in(2) {
                    let word = self.word();
                    fields.insert(String::from_utf8_lossy(&word).into_owned(), taken);
                }
            }
            node => {
                *node = match self.below(8) {
                    0 => Value::Null,
                    1 => Value::String(String::from_utf8_lossy(&self.word()).into_owned()),
                    2 => Value::Array(vec![node.take()]),
                    3 => Value::Object(serde_json::Map::new()),
                    _ => serde_json::from_str(number).unwrap_or(Value::String(number.to_owned())),
                }
            }
        }
    }

    fn word(&mut self) -> Vec<u8> {
        match self.below(4) {
            0 => self.number().as_bytes().to_vec(),
            1 => TOKENS[self.below(TOKENS.len())].as_bytes().to_vec(),
            _ => {
                let idx = self.below(self.words.len());
                self.words.get(idx).cloned().unwrap_or_default()
            }
        }
    }

    /// The beginning of one file and the end of another.
    fn spliced(&mut self, input: &[u8], other: &[u8]) -> Vec<u8> {
        let (end, start) = (self.below(input.len() + 1), self.below(other.len() + 1));
        [&input[..end], &other[start..]].concat()
    }

    /// A part of a file of which every byte fulfils a condition; `None` if the draw hit none.
    fn run_of(&mut self, input: &[u8], is_in: fn(&u8) -> bool) -> Option<std::ops::Range<usize>> {
        let from = self.below(input.len());
        let start = from + input.get(from..)?.iter().position(is_in)?;
        let len = input[start..].iter().position(|byte| !is_in(byte));
        Some(start..len.map_or(input.len(), |len| start + len))
    }

    fn replace_number(&mut self, input: Vec<u8>) -> Vec<u8> {
        let is_number = |byte: &u8| byte.is_ascii_digit() || b"+-.eE".contains(byte);
        let Some(range) = self.run_of(&input, is_number) else { return input };
        let number = self.number().as_bytes();
        [&input[..range.start], number, &input[range.end..]].concat()
    }

    fn replace_word(&mut self, input: Vec<u8>) -> Vec<u8> {
        let is_word = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
        let Some(range) = self.run_of(&input, is_word) else { return input };
        let word = self.word();
        [&input[..range.start], &word, &input[range.end..]].concat()
    }

    fn insert_token(&mut self, input: Vec<u8>) -> Vec<u8> {
        let (at, word) = (self.below(input.len() + 1), self.word());
        [&input[..at], &word, &input[at..]].concat()
    }

    fn flip_byte(&mut self, mut input: Vec<u8>) -> Vec<u8> {
        let (at, bit) = (self.below(input.len()), self.below(8));
        if let Some(byte) = input.get_mut(at) {
            *byte ^= 1 << bit;
        }
        input
    }

    fn range(&mut self, input: &[u8]) -> std::ops::Range<usize> {
        let start = self.below(input.len() + 1);
        let longest = if self.once_in(4) { input.len() - start } else { 16 };
        start..(start + self.below(longest + 1)).min(input.len())
    }

    fn remove_range(&mut self, mut input: Vec<u8>) -> Vec<u8> {
        let range = self.range(&input);
        input.drain(range);
        input
    }

    fn repeat_range(&mut self, input: Vec<u8>) -> Vec<u8> {
        let range = self.range(&input);
        let n = if self.once_in(20) { 1 + self.below(300) } else { 1 };
        let repeated = input[range.clone()].repeat(n.min(1 + LONGEST / (range.len() + 1)));
        [&input[..range.start], &repeated, &input[range.start..]].concat()
    }

    fn lines<'i>(&mut self, input: &'i [u8]) -> (Vec<&'i [u8]>, usize) {
        let lines: Vec<&[u8]> = input.split_inclusive(|byte| *byte == b'\n').collect();
        let idx = self.below(lines.len());
        (lines, idx)
    }

    fn remove_line(&mut self, input: Vec<u8>) -> Vec<u8> {
        let (mut lines, idx) = self.lines(&input);
        if idx < lines.len() {
            lines.remove(idx);
        }
        lines.concat()
    }

    fn repeat_line(&mut self, input: Vec<u8>) -> Vec<u8> {
        let (mut lines, idx) = self.lines(&input);
        if let Some(line) = lines.get(idx).copied() {
            lines.insert(idx, line);
        }
        lines.concat()
    }

    fn swap_lines(&mut self, input: Vec<u8>) -> Vec<u8> {
        let (mut lines, idx) = self.lines(&input);
        let other = self.below(lines.len());
        if !lines.is_empty() {
            lines.swap(idx, other);
        }
        lines.concat()
    }

    fn truncate(&mut self, mut input: Vec<u8>) -> Vec<u8> {
        if self.once_in(4) {
            input.truncate(self.below(input.len() + 1));
        }
        input
    }

    fn other_line_ends(&mut self, input: Vec<u8>) -> Vec<u8> {
        let end: &[u8] = [b"\r\n".as_slice(), b"\r", b"\n\n", b"\n\r", b" \n"][self.below(5)];
        let lines: Vec<&[u8]> = input.split(|byte| *byte == b'\n').collect();
        lines.join(end)
    }

    fn other_encoding(&mut self, input: Vec<u8>) -> Vec<u8> {
        let text = String::from_utf8_lossy(&input).into_owned();
        let wide = || text.encode_utf16();
        match self.below(5) {
            0 => ["\u{feff}", &text].concat().into_bytes(),
            1 => wide().flat_map(u16::to_le_bytes).collect(),
            2 => std::iter::once(0xfeff).chain(wide()).flat_map(u16::to_le_bytes).collect(),
            3 => std::iter::once(0xfeff).chain(wide()).flat_map(u16::to_be_bytes).collect(),
            // Latin 1, as far as it goes.
            _ => text.chars().map(|c| u8::try_from(u32::from(c)).unwrap_or(b'?')).collect(),
        }
    }

    fn other_separator(&mut self, input: Vec<u8>) -> Vec<u8> {
        let separator = b";\t| :"[self.below(5)];
        let with_comma = self.once_in(2);
        let swapped = input.into_iter().map(|byte| match byte {
            b',' => separator,
            b'.' if with_comma => b',',
            byte => byte,
        });
        swapped.collect()
    }

    fn huge_cell(&mut self, input: Vec<u8>) -> Vec<u8> {
        let n = [65_535, 65_536, 70_000, 1000][self.below(4)];
        let cell = ["x", "9", "\"", " ", "é", "_", "0.1"][self.below(7)].repeat(n);
        let at = self.below(input.len() + 1);
        [&input[..at], cell.as_bytes(), &input[at..]].concat()
    }

    fn deep_nesting(&mut self, input: Vec<u8>) -> Vec<u8> {
        let n = [50, 127, 128, 1000, 100_000][self.below(5)];
        let parts = ["[", "{\"a\":", "[[", "a.", "{a=", "(", "\"", "]"];
        let nested = parts[self.below(parts.len())].repeat(n);
        let at = self.below(input.len() + 1);
        [&input[..at], nested.as_bytes(), &input[at..]].concat()
    }

    fn many_lines(&mut self, input: Vec<u8>) -> Vec<u8> {
        let (mut lines, idx) = self.lines(&input);
        if let Some(line) = lines.get(idx).copied() {
            let n = (1 + self.below(20_000)).min(LONGEST / line.len());
            lines.splice(idx..idx, vec![line; n]);
        }
        lines.concat()
    }

    fn many_columns(&mut self, input: Vec<u8>) -> Vec<u8> {
        let (lines, idx) = self.lines(&input);
        let word = [b",".to_vec(), self.word()].concat();
        let n = (1 + self.below(5000)).min(LONGEST / word.len());
        let added = word.repeat(n);
        let all = self.once_in(2) && lines.len() < 20;
        let longer = lines.iter().enumerate().flat_map(|(line_idx, line)| {
            let body = line.strip_suffix(b"\n").unwrap_or(line);
            let tail = if all || line_idx == idx { added.as_slice() } else { &[] };
            [body, tail, b"\n"].concat()
        });
        longer.collect()
    }
}

/// How many values a value consists of, itself included.
fn n_nodes(value: &Value) -> usize {
    1 + match value {
        Value::Array(items) => items.iter().map(n_nodes).sum(),
        Value::Object(fields) => fields.values().map(n_nodes).sum(),
        _ => 0,
    }
}

/// The value of this number, counted from the outermost one.
fn nth_node<'v>(value: &'v mut Value, at: &mut usize) -> Option<&'v mut Value> {
    if *at == 0 {
        return Some(value);
    }
    *at -= 1;
    match value {
        Value::Array(items) => items.iter_mut().find_map(|item| nth_node(item, at)),
        Value::Object(fields) => fields.values_mut().find_map(|item| nth_node(item, at)),
        _ => None,
    }
}
