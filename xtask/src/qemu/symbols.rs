//! What a linked program contains, by its symbols.

use std::path::Path;

use anyhow::{Context, Result};
use object::{Object, ObjectSymbol};

/// Names of all symbols of a program.
pub(crate) fn of(program: &Path) -> Result<Vec<String>> {
    let bytes = std::fs::read(program).with_context(|| format!("cannot read {}", program.display()))?;
    let file = object::File::parse(bytes.as_slice())
        .with_context(|| format!("{} is no program", program.display()))?;
    let names: Vec<String> =
        file.symbols().filter_map(|symbol| symbol.name().ok()).map(str::to_owned).collect();
    anyhow::ensure!(!names.is_empty(), "{} has no symbols", program.display());
    Ok(names)
}

/// Whether it is a routine for numbers in double precision.
pub(crate) fn is_double(name: &str) -> bool {
    let arm = [
        "__aeabi_d",
        "__aeabi_cd",
        "__aeabi_f2d",
        "__aeabi_i2d",
        "__aeabi_ui2d",
        "__aeabi_l2d",
        "__aeabi_ul2d",
    ];
    let gcc = ["df2", "df3", "dfsi", "dfdi", "sidf", "didf", "dfsf2"];
    arm.iter().any(|begin| name.starts_with(begin))
        || name.starts_with("__") && gcc.iter().any(|end| name.ends_with(end))
}

/// Whether it is a routine for floating-point numbers of any precision.
pub(crate) fn is_float(name: &str) -> bool {
    let arm = ["__aeabi_f", "__aeabi_cf", "__aeabi_i2f", "__aeabi_ui2f", "__aeabi_l2f", "__aeabi_ul2f"];
    let gcc = ["sf2", "sf3", "sfsi", "sfdi", "sisf", "disf"];
    is_double(name)
        || arm.iter().any(|begin| name.starts_with(begin))
        || name.starts_with("__") && gcc.iter().any(|end| name.ends_with(end))
}

/// Whether it belongs to the machinery of panics.
pub(crate) fn is_panic(name: &str) -> bool {
    name.contains("panicking") || name.contains("panic_fmt") || name.contains("panic_bounds_check")
}

/// Whether it allocates memory.
pub(crate) fn is_allocator(name: &str) -> bool {
    ["__rust_alloc", "__rust_realloc", "__rdl_alloc", "__rg_alloc", "__rust_dealloc"]
        .iter()
        .any(|part| name.contains(part))
        || ["malloc", "calloc", "realloc", "free"].contains(&name)
}

#[cfg(test)]
mod tests {
    use super::{is_allocator, is_double, is_float, is_panic};

    #[test]
    fn routines_are_told_apart_by_their_names() {
        for name in ["__aeabi_dadd", "__aeabi_d2iz", "__aeabi_f2d", "__muldf3", "__floatsidf", "__truncdfsf2"]
        {
            assert!(is_double(name) && is_float(name), "{name}");
        }
        for name in ["__aeabi_fmul", "__aeabi_i2f", "__aeabi_fcmplt", "__addsf3", "__ltsf2", "__fixsfsi"] {
            assert!(is_float(name) && !is_double(name), "{name}");
        }
        for name in
            ["__aeabi_idiv", "__aeabi_uidivmod", "__aeabi_lmul", "__aeabi_memcpy", "__udivsi3", "main"]
        {
            assert!(!is_float(name), "{name}");
        }
        assert!(is_panic("_ZN4core9panicking5panic17h0E") && !is_panic("_ZN5board6report17h0E"), "panics");
        assert!(
            is_allocator("__rust_alloc") && is_allocator("malloc") && !is_allocator("memcpy"),
            "allocators"
        );
    }
}
