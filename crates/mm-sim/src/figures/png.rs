//! Pictures as PNG, by a renderer of SVG with a font of our own: the same bytes on every machine.

use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

/// DejaVu Sans without the scripts that no picture has; `font/README.md` says how it was made.
const FONT: &[u8] = include_bytes!("font/DejaVuSans-subset.ttf");
const FAMILY: &str = "DejaVu Sans";

/// Largest side of a picture, px.
const LARGEST: f32 = 16_384.0;

/// Why a picture cannot be made a PNG.
#[derive(Debug, thiserror::Error)]
pub enum PngError {
    /// The picture is no SVG that the renderer takes.
    #[error("cannot render the picture: {0}")]
    Svg(#[from] resvg::usvg::Error),
    /// The picture would have no pixel, or too many.
    #[error("a picture of {width} x {height} pixels cannot be made")]
    Size {
        /// Width, px.
        width: f32,
        /// Height, px.
        height: f32,
    },
    /// It cannot be written as PNG.
    #[error("cannot write the PNG: {0}")]
    Encoding(String),
}

/// The PNG of an SVG, with `scale` pixels for each of its own.
///
/// # Errors
/// The SVG is none, or the picture too large.
pub fn png(svg: &str, scale: f32) -> Result<Vec<u8>, PngError> {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family(FAMILY);
    let options = Options { fontdb: Arc::new(fonts), font_family: FAMILY.to_owned(), ..Options::default() };
    let tree = Tree::from_str(svg, &options)?;
    let [width, height] = [tree.size().width(), tree.size().height()].map(|side| (scale * side).ceil());
    let size = PngError::Size { width, height };
    if !(width >= 1.0 && height >= 1.0 && width <= LARGEST && height <= LARGEST) {
        return Err(size);
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 1 and 16384")]
    let mut pixels = Pixmap::new(width as u32, height as u32).ok_or(size)?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| PngError::Encoding(error.to_string()))
}
