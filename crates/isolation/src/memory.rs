//! Memory of a process.

/// `bytes` in a suitable unit.
#[must_use]
pub fn in_words(bytes: u64) -> String {
    match bytes {
        0..10_000 => format!("{bytes} bytes"),
        10_000..10_000_000 => format!("{} kB", bytes / 1000),
        10_000_000..1_000_000_000 => format!("{} MB", bytes / 1_000_000),
        _ => format!("{:.1} GB", bytes as f64 / 1e9),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_have_the_unit_that_fits() {
        let words = [9_999, 65_536, 512_000_000, 2_147_483_648].map(in_words);
        assert_eq!(words, ["9999 bytes", "65 kB", "512 MB", "2.1 GB"]);
    }
}
