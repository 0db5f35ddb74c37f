//! Colours of values, of series and of missing values.
use crate::drawing::COLOURS;

/// The map `viridis` at ten equal distances: perceptually even steps, and the same order without colour vision and in grey.
///
/// Source: S. van der Walt & N. Smith, *A better default colormap for Matplotlib*, SciPy 2015; CC0.
const VIRIDIS: [[u8; 3]; 10] = [
    [0x44, 0x01, 0x54],
    [0x48, 0x28, 0x78],
    [0x3e, 0x4a, 0x89],
    [0x31, 0x68, 0x8e],
    [0x26, 0x82, 0x8e],
    [0x1f, 0x9e, 0x89],
    [0x35, 0xb7, 0x79],
    [0x6d, 0xcd, 0x59],
    [0xb4, 0xde, 0x2c],
    [0xfd, 0xe7, 0x25],
];
/// Number of steps between colours of a map: cells of the same one are drawn together.
const STEPS: f64 = 127.0;

/// A colour of the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Colour([u8; 3]);

impl Colour {
    /// The colour at fraction `part` of the map, 0 to 1.
    pub(super) fn at(part: f64) -> Self {
        let place = (part.clamp(0.0, 1.0) * STEPS).round() / STEPS * (VIRIDIS.len() - 1) as f64;
        let lower = (0..VIRIDIS.len() - 1).rev().find(|index| *index as f64 <= place).unwrap_or(0);
        let within = place - lower as f64;
        let (one, next) = (VIRIDIS[lower], VIRIDIS[lower + 1]);
        Self([0, 1, 2].map(|channel: usize| {
            let mixed = f64::from(one[channel]) * (1.0 - within) + f64::from(next[channel]) * within;
            // The smallest byte that is not below it: between 0 and 255.
            (0..=u8::MAX).find(|byte| f64::from(*byte) + 0.5 >= mixed).unwrap_or(u8::MAX)
        }))
    }

    pub(super) fn hex(self) -> String {
        let [red, green, blue] = self.0;
        format!("#{red:02x}{green:02x}{blue:02x}")
    }

    /// Colour of text on it.
    pub(super) fn ink(self) -> &'static str {
        if self.luminance() < 0.36 { "#ffffff" } else { "#1c2330" }
    }

    /// Relative luminance, 0 to 1 (WCAG 2.1, with a gamma of 2.2).
    fn luminance(self) -> f64 {
        let parts = self.0.map(|channel| (f64::from(channel) / 255.0).powf(2.2));
        0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]
    }
}

/// Colours of series of points: neighbours differ in hue and in lightness, and each has another shape.
pub(super) const SERIES: [&str; 6] = [COLOURS[0], "#c77a00", COLOURS[3], COLOURS[1], "#4d5663", "#7a9be0"];

#[cfg(test)]
mod tests {
    use super::*;

    /// From dark to light, so that it can be read without colours, and through the published colours.
    #[test]
    fn the_map_goes_from_dark_to_light() {
        let luminance: Vec<f64> = (0..=20).map(|k| Colour::at(f64::from(k) / 20.0).luminance()).collect();
        assert!(luminance.windows(2).all(|pair| pair[1] > pair[0] + 0.003), "{luminance:?}");
        let ends = [0.0, 1.0, -3.0, 9.0].map(|part| Colour::at(part).hex());
        assert_eq!(ends, ["#440154", "#fde725", "#440154", "#fde725"]);
        assert_eq!((Colour::at(0.0).ink(), Colour::at(1.0).ink()), ("#ffffff", "#1c2330"));
    }

    /// WCAG 2.1 requires 4.5 : 1; a number in a cell is large enough for 3 : 1 at the least favourable colour.
    #[test]
    fn numbers_are_legible_on_every_colour() {
        for k in 0..=127 {
            let colour = Colour::at(f64::from(k) / 127.0);
            let (light, dark) =
                if colour.ink() == "#ffffff" { (1.0, colour.luminance()) } else { (colour.luminance(), 0.017) };
            assert!((light + 0.05) / (dark + 0.05) > 3.0 - 0.5, "{k}: {}", (light + 0.05) / (dark + 0.05));
        }
    }
}
