//! Malformed scenarios: whatever is in a file, it is read, or refused with a place for everything that is wrong with it.
//!
//! Law: no panic; every problem lies in a line of a text that the scenario is made of, and is shown with it; the command ends with
//! code 2 and the place of the file as given. Why: a typing error has to be found without reading the source.
//! Reference: the bundled scenarios, changed by a seeded generator, and files made by hand. No tolerance.

#![expect(clippy::panic, reason = "a helper of tests reports like a test")]

use mm_sim::experiment::Experiment;
use mm_sim::scenario::{self, ScenarioError};

use crate::common::command::Folder;
use crate::common::scenario::{GOOD, read};

/// Random numbers, the same in every run.
struct Random(u64);

impl Random {
    const fn new() -> Self {
        Self(0x9e37_79b9_7f4a_7c15)
    }

    fn below(&mut self, count: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 >> 33).unwrap_or(0) % count
    }

    fn of<'a>(&mut self, words: &[&'a str]) -> &'a str {
        words[self.below(words.len())]
    }
}

/// Whether every problem is in a line of the text, and shown with its place.
fn is_located(text: &str, error: &ScenarioError) {
    let shown = error.to_string();
    let lines = text.matches('\n').count() + 1;
    assert!(!error.problems().is_empty(), "refused without a reason:\n{text}");
    for problem in error.problems() {
        let (name, line, column) = error.location(problem).unwrap_or_else(|| panic!("no place:\n{shown}"));
        assert!((1..=lines).contains(&line), "line {line} of {lines}:\n{shown}");
        let place = format!("--> {name}:{line}:{column}");
        assert!(shown.contains(&place) || shown.contains(" more"), "{place} is not in:\n{shown}");
    }
    assert_eq!(shown.matches("error: ").count(), shown.matches("--> ").count(), "a place each:\n{shown}");
}

/// Values of the wrong kind, size or sign.
const VALUES: [&str; 20] = [
    "nan",
    "-inf",
    "1e400",
    "-1",
    "0",
    "1e308",
    "99999999999999999999999999999999999999999",
    "\"\"",
    "\"word\"",
    "true",
    "[]",
    "[1]",
    "[[1, 2], [3]]",
    "{ a = 1 }",
    "{}",
    "2024-01-01",
    "\"\"\"\n\"\"\"",
    "'",
    "0x",
    "1_",
];

/// What is no TOML, or not where it is put.
const LINES: [&str; 12] = [
    "[",
    "]]",
    "= 1",
    "key",
    "\"\"= 1",
    "[simulation]",
    "[[simulation]]",
    "a.b.c = 1",
    "unknown = 1",
    "[unknown]",
    "name = 1",
    "\u{0}",
];

/// One change to the lines of a scenario.
fn change(lines: &mut Vec<String>, random: &mut Random) {
    let at = random.below(lines.len());
    let key = lines[at].split_once('=').map(|(key, _)| key.trim().to_owned());
    match (random.below(9), key) {
        (0, _) if lines.len() > 1 => drop(lines.remove(at)),
        (1, _) => lines.insert(at, lines[at].clone()),
        (2, _) => lines.insert(at, random.of(&LINES).to_owned()),
        (3 | 4, Some(key)) => lines[at] = format!("{key} = {}", random.of(&VALUES)),
        (5, Some(key)) => {
            let unit = random.of(&["_mm", "_deg", "_ms", "_lb"]);
            lines[at] = lines[at].replacen(&key, &format!("{key}{unit}"), 1);
        }
        (6, Some(key)) => lines[at] = lines[at].replacen(&key, &key.replacen(['_', 'e'], "", 1), 1),
        (7, _) => {
            let other = random.below(lines.len());
            lines.swap(at, other);
        }
        _ => {
            let cut =
                (0..=lines[at].len()).filter(|&cut| lines[at].is_char_boundary(cut)).collect::<Vec<_>>();
            let cut = cut[random.below(cut.len())];
            lines[at].truncate(cut);
        }
    }
}

#[test]
fn changed_scenarios_are_read_or_refused_with_places() {
    let mut random = Random::new();
    let mut refused = 0;
    for (_, text) in scenario::bundled() {
        for _ in 0..40 {
            let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
            for _ in 0..=random.below(3) {
                change(&mut lines, &mut random);
            }
            let end = random.of(&["\n", "\r\n"]);
            let text = format!("{}{}", random.of(&["", "\u{feff}"]), lines.join(end));
            if let Err(error) = read(&text, &[]).and_then(|loaded| Experiment::build(&loaded)) {
                is_located(&text, &error);
                refused += 1;
            }
        }
    }
    assert!(refused >= 300, "{refused} of them are malformed");
}

/// Files as they come from elsewhere: each is refused with its place by the command itself.
#[test]
fn files_made_by_hand_are_refused_by_the_command() {
    let folder = Folder::new("malformed");
    let good = |from: &str, to: &str| GOOD.replace(from, to).into_bytes();
    let cases: [(&str, Vec<u8>, &str); 22] = [
        ("empty", Vec::new(), "1:1"),
        ("blank", b"\n \n\t\n".to_vec(), "1:1"),
        ("bom-alone", b"\xef\xbb\xbf".to_vec(), "1:1"),
        ("null", b"\0".to_vec(), "1:1"),
        ("latin1", b"name = \"\xe9\"\n".to_vec(), "1:9"),
        ("utf16", b"\xff\xfen\0a\0".to_vec(), "1:1"),
        ("binary", (0..=255).collect(), "2:118"),
        ("json", b"{\"name\": \"test\"}".to_vec(), "1:1"),
        ("yaml", b"name: test\nsimulation:\n  duration_s: 1\n".to_vec(), "1:5"),
        ("one-word", b"square".to_vec(), "1:7"),
        ("deep", "[".repeat(500).into_bytes(), "1:"),
        ("deep-value", format!("a = {}", "[".repeat(5000)).into_bytes(), "1:"),
        ("long-line", format!("{} = 1", "k".repeat(100_000)).into_bytes(), "1:1"),
        ("cr", GOOD.replace('\n', "\r").into_bytes(), "1:"),
        ("two-names", good("[simulation]", "name = \"again\"\n[simulation]"), "3:1"),
        ("two-tables", good("[robot]", "[simulation]"), "8:"),
        ("inf", good("-0.3", "inf"), "16:13"),
        ("huge", good("duration_s = 2", "duration_s = 1e300"), "4:14"),
        ("huge-integer", good("duration_s = 2", &format!("duration_s = {}", "9".repeat(400))), "4:14"),
        ("unit", good("radius_m", "radius_mm"), "15:1"),
        (
            "crlf",
            good("base_mass_kg = 50.0", "base_mass_kg = -50.0")
                .iter()
                .flat_map(|&byte| if byte == b'\n' { vec![b'\r', b'\n'] } else { vec![byte] })
                .collect(),
            "10:16",
        ),
        ("bom", [b"\xef\xbb\xbf".to_vec(), good("radius_m = 1.0", "radius_m = 0")].concat(), "15:12"),
    ];
    for (name, bytes, place) in cases {
        let file = format!("{name}.toml");
        std::fs::write(folder.path(&file), bytes).expect("a file of our own");
        let ended = folder.expect(2, &["scenario", "check", &file]);
        assert!(ended.stdout.is_empty(), "{file}: nothing on standard output:\n{}", ended.stdout);
        let place = format!("--> {file}:{place}");
        assert!(ended.stderr.contains(&place), "{place:?} is not in:\n{}", ended.stderr);
    }
}

#[test]
fn missing_file() {
    let cases = [
        ("sqare.toml", "`square`"),
        ("sqare", "`square`"),
        ("nowhere/spiral.toml", "`spiral`"),
        ("square-compar", "`square-compare`"),
        ("nothing-like-it.toml", "no bundled scenario of that name"),
    ];
    for (spec, near) in cases {
        let error = scenario::load(spec, &[]).err().unwrap_or_else(|| panic!("{spec} exists"));
        let shown = error.to_string();
        assert!(shown.contains(&format!("`{spec}`")) && shown.contains(near), "{spec}: {shown}");
    }
}

/// No text, however mangled, brings the reader down or makes it speak of a place outside the text.
#[test]
fn mangled_files_are_answered() {
    let mut random = Random::new();
    let pieces = [
        "[",
        "]]",
        "=",
        "\"",
        "\n",
        ".",
        "nan",
        "-1",
        "{",
        "}",
        "\u{e9}",
        "\t",
        "''",
        "[[robot.link]]\n",
        "\r\n",
    ];
    for (_, text) in scenario::bundled() {
        for _ in 0..150 {
            let mut characters: Vec<char> = text.chars().collect();
            for _ in 0..=random.below(4) {
                let at = random.below(characters.len());
                let until = (at + random.below(12)).min(characters.len());
                characters.splice(at..until, pieces[random.below(pieces.len())].chars());
            }
            let mangled: String = characters.into_iter().collect();
            let Err(error) = read(&mangled, &["robot.link.2.mass_kg=\u{e9}"]) else { continue };
            is_located(&mangled, &error);
        }
    }
}

#[test]
fn a_hopeless_file_is_answered_briefly() {
    let text: String = (0..500).map(|index| format!("key{index} = 1\n")).collect();
    let shown = read(&text, &[]).err().map(|error| error.to_string()).unwrap_or_default();
    assert!(
        shown.ends_with("and 473 more") && shown.matches("error: ").count() == 30,
        "thirty of 503: {shown}"
    );
}

#[test]
fn a_file_that_is_no_text_is_refused_with_the_place_of_its_first_bad_byte() {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("not_text.toml");
    std::fs::write(&path, b"name = \"a\"\nab\xff\xfe = 1\n").expect("a folder of our own");
    let error = scenario::load(&path.display().to_string(), &[]).expect_err("bytes are no scenario");
    let text = error.to_string();
    for part in ["not_text.toml", "not_text.toml:2:3", "not UTF-8", "expected a TOML text"] {
        assert!(text.contains(part), "{part:?} is not in:\n{text}");
    }
}
