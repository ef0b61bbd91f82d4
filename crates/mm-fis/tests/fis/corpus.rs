//! Law: files in the style of the real world are read to what they say; each of those with one mistake is refused, at its place, with
//! what was expected. And no text at all breaks the readers: it is refused with places in it, or what is read from it is written,
//! read again, and evaluated to finite numbers (`common/law.rs`, which the fuzz targets check too).
//!
//! Reference: the files, read by eye; the `.txt` beside each is the system as the writer writes it, with the notes, or the problems.
//! `MMSIM_BLESS=1 cargo test -p mm-fis --test fis corpus` writes them anew. Tolerance: none.

#![expect(clippy::panic, reason = "the helpers are part of the tests")]

use crate::common::law;
use std::fs;
use std::path::{Path, PathBuf};

use mm_control::fuzzy::{And, Connective, MembershipFunction as Mf};
use mm_fis::{Defuzzification, Document, Kind, Shape, System, read, read_fcl, read_fis, write_fis};
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng};

/// The files of a folder of the corpus, with their texts, in order.
fn files(folder: &str) -> Vec<(PathBuf, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(folder);
    let entries = fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending != "txt"));
    paths.sort();
    let text = |path: &PathBuf| fs::read_to_string(path).unwrap_or_else(|error| panic!("{error}"));
    paths.into_iter().map(|path| (path.clone(), text(&path))).collect()
}

/// Compares with the file beside, or writes it anew.
fn compare(path: &Path, found: &str) {
    let mut beside = path.as_os_str().to_owned();
    beside.push(".txt");
    if std::env::var_os("MMSIM_BLESS").is_some() {
        fs::write(&beside, found).unwrap_or_else(|error| panic!("{error}"));
    }
    let golden = fs::read_to_string(&beside).unwrap_or_default().replace("\r\n", "\n");
    assert_eq!(found, golden, "{}", path.display());
}

fn read_file(path: &Path, text: &str) -> Result<Document, String> {
    read(&path.display().to_string(), text).map_err(|error| error.to_string())
}

#[test]
fn good_files_are_read() {
    let files = files("good");
    assert!(files.len() >= 18, "{} files", files.len());
    for (path, text) in files {
        let Document { system, notes } =
            read_file(&path, &text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let notes: String = notes.iter().map(|note| format!("{note}\n")).collect();
        compare(&path, &format!("{}\n{notes}", write_fis(&system)));
    }
}

#[test]
fn bad_files_are_refused() {
    let files = files("bad");
    assert!(files.len() >= 40, "{} files", files.len());
    for (path, text) in files {
        match read_file(&path, &text) {
            Ok(_) => panic!("{} was read", path.display()),
            Err(error) => compare(&path, &format!("{error}\n")),
        }
    }
}

fn good(name: &str) -> System {
    let (path, text) = files("good")
        .into_iter()
        .find(|(path, _)| path.ends_with(name))
        .unwrap_or_else(|| panic!("no {name}"));
    read_file(&path, &text).unwrap_or_else(|error| panic!("{error}")).system
}

#[test]
fn spot_checks() {
    let set = |system: &System, input: usize, term: usize| system.inputs[input].terms[term].shape.clone();
    let tipper = good("tipper_matlab.fis");
    assert_eq!(set(&tipper, 0, 1), Shape::Set(Mf::Gaussian([1.5, 5.0])), "good");
    assert_eq!(tipper.rules[1].inputs, [2, 0], "don't care");
    for same in ["crlf.fis", "old_mac.fis", "bom.fis", "edited.fis"] {
        let system = good(same);
        assert_eq!(system.rules, tipper.rules, "{same}");
        assert_eq!(system.outputs, tipper.outputs, "{same}");
        assert_eq!(set(&system, 1, 1), set(&tipper, 1, 1), "{same}");
    }
    assert_eq!(good("bom.fis").name, "Trinkgeld f\u{fc}r \u{c4}rger", "UTF-8");
    let edited = good("edited.fis");
    assert_eq!(edited.inputs[0].name, "it's \"service\"", "doubled quote");
    let names: Vec<_> = edited.inputs[0].terms.iter().map(|term| term.name.as_str()).collect();
    assert_eq!(names, ["poor, 50% off", "good: [really]", "bob's"], "signs within quotes");
    let three = good("three_inputs.fis");
    assert_eq!((three.inputs.len(), three.outputs.len(), three.and), (3, 2, And::Prod), "shower");
    assert_eq!((three.rules[3].outputs.as_slice(), three.rules[1].weight), (&[1, -1][..], 0.75), "shower");
    assert_eq!(good("octave.fis").defuzzification, Defuzzification::Bisector, "octave");
    let linear = good("sugeno_linear.fis");
    assert_eq!((linear.kind, linear.and), (Kind::Sugeno, And::Prod), "MATLAB's defaults of Sugeno");
    assert_eq!(linear.outputs[0].terms[2].shape, Shape::Linear(vec![-0.15, 0.0, 3.0]), "linear");
    assert_eq!(set(&good("fuzzylite.fis"), 0, 0), Shape::Set(Mf::LinearZ([0.0, 1.0])), "a falling ramp");
    let open = good("open_sides.fis");
    assert_eq!(set(&open, 0, 0), Shape::Set(Mf::LinearZ([30.0, 50.0])), "open below");
    assert_eq!(set(&open, 0, 2), Shape::Set(Mf::LinearS([50.0, 70.0])), "open above");
    let minimal = good("minimal.fis");
    assert_eq!((minimal.inputs[0].name.as_str(), minimal.rules[0].weight), ("input1", 0.0), "minimal");
    let brackets = good("brackets.fcl");
    let rules: Vec<_> = brackets.rules.iter().map(|rule| rule.inputs.as_slice()).collect();
    assert_eq!(rules, [[2, 1, 0], [2, 0, 1], [1, -2, 0], [0, -2, -1], [0, 2, 0], [0, -1, 0]], "brackets");
    let shapes = good("jfuzzylogic_shapes.fcl");
    assert_eq!(set(&shapes, 0, 2), Shape::Set(Mf::Gaussian([2.0, 5.0])), "mean before sigma");
    assert_eq!(
        (shapes.rules[1].inputs.as_slice(), shapes.rules[1].connective),
        (&[-2, -2][..], Connective::Or),
        "De Morgan"
    );
}

#[test]
fn the_law_holds_for_the_corpus() {
    for (path, text) in files("good").into_iter().chain(files("bad")) {
        let is_good = path.parent().is_some_and(|folder| folder.ends_with("good"));
        let reader = if path.extension().is_some_and(|ending| ending == "fcl") { read_fcl } else { read_fis };
        assert_eq!(law::holds(&text, reader), is_good, "{}", path.display());
    }
}

/// Parts that a mutation puts into a text.
const PARTS: [&str; 30] = [
    "[",
    "]",
    "'",
    "\"",
    "=",
    ":",
    ",",
    " ",
    "\n",
    "\r",
    "%",
    "-",
    "1e308",
    "-1e308",
    "1e-310",
    "nan",
    "0",
    "999999999999",
    "(",
    ")",
    "''",
    "\u{2019}",
    "\u{feff}",
    "MF1",
    "[Rules]",
    "(*",
    " OR ",
    " AND NOT ",
    "constant",
    "END_FUZZIFY",
];

/// A text with a few changes: parts cut, doubled, taken from another or put in, and other digits.
fn mutated(text: &str, other: &str, random: &mut TestRng) -> String {
    let mut text: Vec<char> = text.chars().collect();
    let other: Vec<char> = other.chars().collect();
    for _ in 0..=random.next_u32() % 2 {
        let mut below = |limit: usize| random.next_u32() as usize % limit.max(1);
        let at = below(text.len() + 1);
        let length = below(12).min(text.len() - at);
        match below(9) {
            0 => drop(text.drain(at..at + length)),
            1 => {
                let part = text[at..at + length].to_vec();
                let to = below(text.len() + 1);
                drop(text.splice(to..to, part));
            }
            2 => drop(text.splice(at..at + length, PARTS[below(PARTS.len())].chars())),
            3 => drop(text.splice(at..at, PARTS[below(PARTS.len())].chars())),
            4..8 => {
                // Another digit: most such texts are still read, to other numbers.
                let digits: Vec<_> = (0..text.len()).filter(|&at| text[at].is_ascii_digit()).collect();
                if let Some(&at) = digits.get(below(digits.len())) {
                    text[at] = ['0', '1', '2', '3', '5', '9'][below(6)];
                }
            }
            _ => {
                let from = below(other.len() + 1);
                let part = other[from..(from + 30).min(other.len())].to_vec();
                drop(text.splice(at..at + length, part));
            }
        }
    }
    text.into_iter().collect()
}

#[test]
fn the_law_holds_for_mutations_of_the_corpus() {
    let (good, bad) = (files("good"), files("bad"));
    let all: Vec<_> = good.iter().chain(&good).chain(&good).chain(&good).chain(&bad).collect();
    let mut random = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let mut was_read = 0;
    for round in 0..6000 {
        let (path, text) = &all[round % all.len()];
        let other = &all[random.next_u32() as usize % all.len()].1;
        let text = mutated(text, other, &mut random);
        let fcl = path.extension().is_some_and(|ending| ending == "fcl");
        was_read += usize::from(law::holds(&text, if fcl { read_fcl } else { read_fis }));
    }
    assert!(was_read > 300, "{was_read} of 6000 mutations were read: too few to say anything of systems");
}
