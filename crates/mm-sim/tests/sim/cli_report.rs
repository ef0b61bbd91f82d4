//! `mmsim report` and `mmsim plot`: files where they should be, whole, and harmless whatever is in the logs.
//!
//! Laws: one file with all it needs; nothing in it is fetched; text of a log stays text; SVG is XML, PNG has the size asked for; 2 for
//! what cannot be read, 1 for what cannot be written. Why: reports are sent to others, figures go into papers.
//! Reference: the texts themselves, `roxmltree`, the PNG's header. No tolerance. What the page does is tried in a browser by `cargo xtask report`.

#![expect(clippy::panic, reason = "a helper that cannot go on is a failed test")]

use crate::common::command::Folder;

const SHORT: [&str; 2] = ["--set", "simulation.duration_s=0.3"];

/// Logs of two laws over a short time, in the folder's `out`.
fn two(folder: &Folder) -> [&'static str; 2] {
    compared(folder, &SHORT).1
}

/// The table of two laws with more options, and their logs in the folder's `out`.
fn compared(folder: &Folder, more: &[&str]) -> (String, [&'static str; 2]) {
    let args = ["compare", "--scenario", "square-compare", "--controllers", "bsmc,bfsmc"];
    let table = folder.expect(0, &[&args, more].concat()).stdout;
    (table, ["out/square-compare.bsmc.mcap", "out/square-compare.bfsmc.mcap"])
}

fn text(folder: &Folder, name: &str) -> String {
    std::fs::read_to_string(folder.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn the_report_is_beside_the_first_log_or_where_it_is_told() {
    let folder = Folder::new("report-place");
    // Whole runs: the thesis's numbers stand beside no others.
    let (_, [one, other]) = compared(&folder, &[]);
    let ended = folder.expect(0, &["report", one, other]);
    assert_eq!(ended.stdout, "out/report.html\n", "where it is");
    let page = text(&folder, "out/report.html");
    for part in [
        "<h1>square-compare</h1>",
        "2 runs: bsmc, bfsmc",
        "All metrics",
        "10.98",
        "31.16 %",
        "name = &quot;square-compare&quot;",
        mm_sim::VERSION,
        "Content-Security-Policy",
    ] {
        assert!(page.contains(part), "{part:?} is in the page");
    }
    let own = page.split("<script").next().unwrap_or_default();
    assert!(
        !own.contains(" src=") && !own.contains("@import") && !own.contains("href=\"http"),
        "nothing is fetched"
    );
    assert!(
        page.contains("default-src &#39;none&#39;") || page.contains("default-src 'none'"),
        "nor may it be"
    );
    folder.expect(0, &["report", other, "--out", "new/folder"]);
    assert!(text(&folder, "new/folder/report.html").contains("<p>bfsmc</p>"), "one run");
}

#[test]
fn text_of_a_log_ends_no_element() {
    let folder = Folder::new("report-hostile");
    let hostile = "<script>alert(1)<!--<img src=x onerror=alert(2)>";
    let scenario = format!(
        "# </script></pre><script>alert(3)</script>\nname = '{hostile}'\n[simulation]\nduration_s = 0.1\n\
         [trajectory]\nkind = \"square\"\n"
    );
    folder.write("hostile.toml", &scenario);
    folder.expect(0, &["--scenario", "hostile.toml", "--out", "logs", "--quiet"]);
    let log = format!("logs/{hostile}.mcap");
    folder.expect(0, &["report", &log, "--out", "here"]);
    folder.expect(0, &["report", &log, "--out", "plain"]);
    let page = text(&folder, "here/report.html");
    // Theme, data, uPlot, three.js and the page's own script.
    assert_eq!(page.matches("<script").count(), 5, "no script but the page's");
    assert_eq!(page.matches("</script").count(), 5, "none ends early");
    assert!(!page.contains("<img") && !page.contains("<!--<"), "no element of the log's");
    assert!(page.contains("&lt;script&gt;alert(1)"), "the name is there as text");
    folder.expect(0, &["plot", &log, "-o", "x.svg"]);
    let svg = text(&folder, "x.svg");
    let svg = roxmltree::Document::parse(&svg).expect("XML");
    assert!(!svg.descendants().any(|node| node.has_tag_name("script")), "no script in the figure");
}

#[test]
fn a_torn_log_is_shown_with_a_warning_and_no_log_is_bad_input() {
    let folder = Folder::new("report-torn");
    let [one, _] = two(&folder);
    let bytes = std::fs::read(folder.path(one)).expect("a log");
    let outcome = bytes.windows(12).position(|window| window == b"mmsim.result").expect("the outcome");
    std::fs::write(folder.path("torn.mcap"), &bytes[..outcome]).expect("a file");
    let ended = folder.expect(0, &["report", "torn.mcap"]);
    for warning in ["the file is torn", "the run did not reach its end"] {
        assert!(ended.stderr.contains(&format!("warning: torn.mcap: {warning}")), "{}", ended.stderr);
    }
    assert!(text(&folder, "report.html").contains("unfinished"), "and the page says so");
    let ended = folder.expect(2, &["report", "none.mcap"]);
    assert!(ended.stderr.starts_with("error: cannot read the log none.mcap: "), "{}", ended.stderr);
    folder.write("text.mcap", "no log");
    let ended = folder.expect(2, &["plot", "text.mcap", "-o", "x.svg"]);
    assert_eq!(ended.stderr, "error: text.mcap: this is no MCAP file; `mmsim run` writes one\n", "no log");
    folder.expect(2, &["report"]);
    folder.write("file", "");
    let ended = folder.expect(1, &["report", one, "--out", "file/below"]);
    assert!(ended.stderr.starts_with("error: cannot write file/below/report.html: "), "{}", ended.stderr);
}

#[test]
fn figures_are_svg_or_png_by_their_extension() {
    let folder = Folder::new("plot");
    let [one, other] = two(&folder);
    let ended = folder.expect(0, &["plot", one, other, "-o", "papers/x.svg", "--title", "Title & more"]);
    assert_eq!(ended.stdout, "papers/x.svg\n", "where it is");
    let svg = text(&folder, "papers/x.svg");
    let xml = roxmltree::Document::parse(&svg).expect("XML");
    let texts: Vec<&str> = xml.descendants().filter_map(|node| node.text()).map(str::trim).collect();
    for part in ["Title & more", "bsmc", "bfsmc", "error x (mm)", "torque joint 3 (N m)"] {
        assert!(texts.contains(&part), "{part:?} is in the figure");
    }
    folder.expect(0, &["plot", one, "-o", "x.png", "--figure", "path", "--scale", "2"]);
    folder.expect(0, &["plot", one, "-o", "x.svg", "--figure", "path"]);
    let png = std::fs::read(folder.path("x.png")).expect("a picture");
    assert!(png.starts_with(b"\x89PNG\r\n\x1a\n"), "a PNG");
    let side = |at: usize| {
        png.get(at..at + 4).map(|bytes| bytes.iter().fold(0, |all, byte| 256 * all + u32::from(*byte)))
    };
    let svg = text(&folder, "x.svg");
    let size = format!("width=\"{}\" height=\"{}\"", side(16).unwrap_or(0) / 2, side(20).unwrap_or(0) / 2);
    assert!(svg.contains(&size), "twice the size of the figure: {size}");
    folder.expect(0, &["plot", one, other, "-o", "all.svg", "--figure", "all"]);
    let kinds = mm_sim::figures::Kind::ALL.map(|(_, name)| name);
    for kind in kinds {
        let svg = text(&folder, &format!("all-{kind}.svg"));
        assert!(roxmltree::Document::parse(&svg).is_ok(), "{kind} is XML");
    }
    let ended = folder.expect(2, &["plot", one, "-o", "x.pdf"]);
    assert!(ended.stderr.contains("expected a name that ends in .svg or .png"), "{}", ended.stderr);
    folder.expect(2, &["plot", one, "-o", "x.svg", "--figure", "nothing"]);
    folder.expect(2, &["plot", one, "-o", "x.png", "--scale", "0"]);
}

#[test]
fn the_thesis_stands_beside_whole_runs_of_its_experiment_alone() {
    let folder = Folder::new("beside");
    for (more, is_there) in [(&["--set", "simulation.duration_s=1"][..], false), (&[], true)] {
        let (table, [one, other]) = compared(&folder, more);
        folder.expect(0, &["report", one, other]);
        let page = text(&folder, "out/report.html");
        for part in ["10.98", "47.31 %", "31.16 %"] {
            assert_eq!(table.contains(part), is_there, "{part} with {more:?} in\n{table}");
            assert_eq!(page.contains(part), is_there, "{part} in the report with {more:?}");
        }
    }
}
