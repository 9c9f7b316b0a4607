//! Partial images: the integers themselves as layers, so that parts merge and checkpoints resume without losing a bit.
//!
//! A 128-bit sum is four unsigned 32-bit channels, lowest word first.

use super::aov::{AovSet, AovTile, Ids};
use super::{Counts, Film, FilmLayout, Rect, SpectralBins, fixed};
use kirkas_images::{Attribute, ChannelData, Image};

/// Why an image is no partial image, or two do not fit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PartError {
    /// The integers are missing.
    #[error("the image has no integer layers (`{0}` is missing), so it cannot be merged or resumed exactly")]
    NotAPart(String),
    /// Size, crop, light groups, spectral bins or AOVs differ.
    #[error("the images do not fit together: {0}")]
    Different(String),
}

const CHANNELS: [&str; 3] = ["R", "G", "B"];
const VALUES: usize = 10;

/// Add the integers of `film` to `image` (which has the film's windows).
pub fn write_part(film: &Film, image: &mut Image) {
    let planes = film.layout.planes();
    let mut push = |name: String, value: &dyn Fn(&super::Tile, usize) -> i128| {
        for word in 0..4 {
            let data = film.plane(|t, i| fixed::to_words(value(t, i))[word]);
            image.push(format!("kirkas.{name}.{word}"), ChannelData::U32(data));
        }
    };
    for (c, channel) in CHANNELS.into_iter().enumerate() {
        for plane in 0..planes {
            push(format!("sum.{plane}.{channel}"), &|t, i| t.sums[i * planes + plane][c]);
        }
        push(format!("square.{channel}"), &|t, i| t.squares[i][c]);
    }
    let bins = film.layout.bin_count();
    for bin in 0..bins {
        push(format!("bin.{bin}"), &|t, i| t.bins[i * bins + bin]);
    }
    if !film.layout.aovs.is_empty() {
        for k in 0..VALUES {
            push(format!("aov.{k}"), &|t, i| t.aovs.as_ref().map_or(0, |a| a.values[i][k]));
        }
        let mut ids = |name: &str, pick: &dyn Fn(&AovTile, usize) -> u32| {
            let data = film.plane(|t, i| t.aovs.as_ref().map_or(0, |a| pick(a, i)));
            image.push(format!("kirkas.id.{name}"), ChannelData::U32(data));
        };
        ids("hits", &|a, i| a.hits[i]);
        ids("sample", &|a, i| a.ids[i].sample);
        ids("object", &|a, i| a.ids[i].object);
        ids("material", &|a, i| a.ids[i].material);
    }
    image.push("kirkas.count.taken", ChannelData::U32(film.plane(|t, i| t.counts[i].taken)));
    image.push("kirkas.count.invalid", ChannelData::U32(film.plane(|t, i| t.counts[i].invalid)));
    if film.tiles.iter().flat_map(|t| &t.counts).any(|c| c.is_stopped) {
        image.push("kirkas.count.stopped", ChannelData::U32(film.plane(|t, i| u32::from(t.counts[i].is_stopped))));
    }
    let text = |s: String| Attribute::Text(s);
    image.attributes.insert(
        "kirkas.groups".into(),
        text(film.layout.groups.iter().map(|g| escaped(g)).collect::<Vec<_>>().join("\n")),
    );
    if let Some(bins) = film.layout.bins {
        image.attributes.insert("kirkas.spectral_bins".into(), text(bins.to_string()));
    }
    image.attributes.insert("kirkas.aovs".into(), Attribute::Number(f64::from(film.layout.aovs.0)));
}

/// A name on one line.
fn escaped(name: &str) -> String {
    name.replace('\\', "\\\\").replace('\n', "\\n")
}

fn unescaped(line: &str) -> String {
    let mut out = String::new();
    let mut chars = line.chars();
    while let Some(c) = chars.next() {
        match (c, c == '\\') {
            (_, true) => out.push(if chars.next() == Some('n') { '\n' } else { '\\' }),
            (c, _) => out.push(c),
        }
    }
    out
}

/// The film that [`write_part`] stored.
pub fn read_part(image: &Image) -> Result<Film, PartError> {
    let missing = |n: &str| PartError::NotAPart(n.to_string());
    let groups: Vec<String> = match image.attributes.get("kirkas.groups") {
        Some(Attribute::Text(t)) if t.is_empty() => Vec::new(),
        Some(Attribute::Text(t)) if t.matches('\n').count() >= image.channels.len() => {
            return Err(PartError::Different("it names more light groups than it has layers".into()));
        }
        Some(Attribute::Text(t)) => t.split('\n').map(unescaped).collect(),
        _ => return Err(missing("kirkas.groups")),
    };
    let aovs = match image.attributes.get("kirkas.aovs") {
        Some(Attribute::Number(n)) => AovSet(*n as u16),
        _ => return Err(missing("kirkas.aovs")),
    };
    let bins = match image.attributes.get("kirkas.spectral_bins") {
        None => None,
        Some(Attribute::Text(t)) => match SpectralBins::parse(t) {
            Some(bins) if bins.count as usize <= image.channels.len() => Some(bins),
            _ => return Err(PartError::Different(format!("it cannot have the spectral bins `{t}`"))),
        },
        Some(_) => return Err(missing("kirkas.spectral_bins")),
    };
    let (d, w) = (image.data, image.display);
    if d.x < 0
        || d.y < 0
        || d.x as i64 + i64::from(d.width) > i64::from(w.width)
        || d.y as i64 + i64::from(d.height) > i64::from(w.height)
    {
        return Err(PartError::Different("its data window lies outside the image".into()));
    }
    let (x0, y0) = (d.x as u32, d.y as u32);
    let crop = Rect { x0, y0, x1: x0 + d.width, y1: y0 + d.height };
    let layout = FilmLayout { size: (w.width, w.height), crop, groups, aovs, bins };
    let mut film = Film::new(layout);
    let (planes, bin_count) = (film.layout.planes(), film.layout.bin_count());

    let integers = |name: &str| -> Result<&[u32], PartError> {
        image.channel(name).and_then(ChannelData::integers).ok_or_else(|| missing(name))
    };
    let sums = |name: String| -> Result<[&[u32]; 4], PartError> {
        let word = |w: usize| integers(&format!("kirkas.{name}.{w}"));
        Ok([word(0)?, word(1)?, word(2)?, word(3)?])
    };
    let value = |words: &[&[u32]; 4], i: usize| fixed::from_words(words.map(|w| w[i]));
    let width = crop.width();
    let mut each = |set: &mut dyn FnMut(&mut super::Tile, usize, usize)| {
        for tile in &mut film.tiles {
            let r = tile.rect;
            for i in 0..r.area() {
                let (x, y) = (r.x0 - x0 + i as u32 % r.width(), r.y0 - y0 + i as u32 / r.width());
                set(tile, i, y as usize * width as usize + x as usize);
            }
        }
    };
    for (c, channel) in CHANNELS.into_iter().enumerate() {
        for plane in 0..planes {
            let words = sums(format!("sum.{plane}.{channel}"))?;
            each(&mut |t, i, at| t.sums[i * planes + plane][c] = value(&words, at));
        }
        let words = sums(format!("square.{channel}"))?;
        each(&mut |t, i, at| t.squares[i][c] = value(&words, at));
    }
    for bin in 0..bin_count {
        let words = sums(format!("bin.{bin}"))?;
        each(&mut |t, i, at| t.bins[i * bin_count + bin] = value(&words, at));
    }
    let (taken, invalid) = (integers("kirkas.count.taken")?, integers("kirkas.count.invalid")?);
    let stopped = image.channel("kirkas.count.stopped").and_then(ChannelData::integers);
    each(&mut |t, i, at| {
        let is_stopped = stopped.is_some_and(|s| s[at] != 0);
        t.counts[i] = Counts { taken: taken[at], invalid: invalid[at].min(taken[at]), is_stopped };
    });
    if !aovs.is_empty() {
        for k in 0..VALUES {
            let words = sums(format!("aov.{k}"))?;
            each(&mut |t, i, at| {
                if let Some(a) = &mut t.aovs {
                    a.values[i][k] = value(&words, at);
                }
            });
        }
        let (hits, sample, object, material) = (
            integers("kirkas.id.hits")?,
            integers("kirkas.id.sample")?,
            integers("kirkas.id.object")?,
            integers("kirkas.id.material")?,
        );
        each(&mut |t, i, at| {
            if let Some(a) = &mut t.aovs {
                a.hits[i] = hits[at];
                a.ids[i] = Ids { sample: sample[at], object: object[at], material: material[at] };
            }
        });
    }
    Ok(film)
}

impl Film {
    /// Add another film's sums. Which samples they hold is the caller's to check: they must differ.
    pub fn merge(&mut self, other: &Film) -> Result<(), PartError> {
        if self.layout != other.layout {
            let (a, b) = (&self.layout, &other.layout);
            let what = if a.size != b.size {
                format!("one is {}x{}, the other {}x{}", a.size.0, a.size.1, b.size.0, b.size.1)
            } else if a.crop != b.crop {
                "their crop windows differ".to_string()
            } else if a.groups != b.groups {
                "their light groups differ".to_string()
            } else if a.bins != b.bins {
                "their spectral bins differ".to_string()
            } else {
                "their AOVs differ".to_string()
            };
            return Err(PartError::Different(what));
        }
        for (a, b) in self.tiles.iter_mut().zip(&other.tiles) {
            add(&mut a.sums, &b.sums, i128::wrapping_add);
            a.bins.iter_mut().zip(&b.bins).for_each(|(x, y)| *x = x.wrapping_add(*y));
            add(&mut a.squares, &b.squares, i128::saturating_add);
            for (x, y) in a.counts.iter_mut().zip(&b.counts) {
                x.taken += y.taken;
                x.invalid += y.invalid;
            }
            if let (Some(x), Some(y)) = (&mut a.aovs, &b.aovs) {
                x.merge(y);
            }
            a.invalid.extend(&b.invalid);
        }
        Ok(())
    }
}

fn add(sums: &mut [[i128; 3]], others: &[[i128; 3]], plus: fn(i128, i128) -> i128) {
    for (a, b) in sums.iter_mut().zip(others) {
        *a = std::array::from_fn(|c| plus(a[c], b[c]));
    }
}
