//! The attributes of an EXR header: which are ours to keep, and how they enter the bytes.
//!
//! The `exr` crate keeps free attributes in a hash map, whose order differs from run to run. So a file is
//! written without them, and they are put in afterwards, sorted by name, before the first attribute:
//! <https://openexr.com/en/latest/OpenEXRFileLayout.html>.

use crate::error::{Result, damaged, unwritable};
use crate::image::Attribute;
use exr::meta::attribute::AttributeValue;
use exr::meta::header::Header;
use std::collections::BTreeMap;

/// Magic number and version field.
const PREAMBLE: usize = 8;
/// The bit in the version field that allows names of 32 to 255 bytes.
const LONG_NAMES: u8 = 0x04;

/// The attributes that describe the file, not the picture.
const STRUCTURE: [&str; 16] = [
    "channels",
    "chromaticities",
    "chunkCount",
    "compression",
    "dataWindow",
    "displayWindow",
    "dwaCompressionLevel",
    "lineOrder",
    "maxSamplesPerPixel",
    "name",
    "pixelAspectRatio",
    "screenWindowCenter",
    "screenWindowWidth",
    "tiles",
    "type",
    "version",
];

/// The texts and numbers of a header that say something about the picture.
pub(crate) fn attributes_of(header: &Header) -> BTreeMap<String, Attribute> {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    header
        .all_named_attributes()
        .filter_map(|(name, value)| {
            let value = match value {
                AttributeValue::Text(value) => Attribute::Text(text(value.as_slice())),
                AttributeValue::F64(value) => Attribute::Number(value),
                AttributeValue::F32(value) => Attribute::Number(f64::from(value)),
                AttributeValue::I32(value) => Attribute::Number(f64::from(value)),
                _ => return None,
            };
            Some((text(name), value))
        })
        .filter(|(name, _)| !STRUCTURE.contains(&name.as_str()))
        .collect()
}

/// Put attributes into the bytes of a single-part file whose `chunks` offsets follow its header.
pub(crate) fn insert_attributes(
    mut file: Vec<u8>,
    attributes: &BTreeMap<String, Attribute>,
    chunks: usize,
) -> Result<Vec<u8>> {
    // Write the new attributes as they stand in a file.
    let mut inserted = Vec::new();
    for (name, value) in attributes {
        check_name("attribute", name)?;
        if STRUCTURE.contains(&name.as_str()) {
            return Err(unwritable("EXR", format!("attribute `{name}` belongs to the format; choose another name")));
        }
        let number;
        let (kind, bytes): (&[u8], &[u8]) = match value {
            Attribute::Text(text) => (b"string", text.as_bytes()),
            Attribute::Number(value) => {
                number = value.to_le_bytes();
                (b"double", &number)
            }
        };
        let length = i32::try_from(bytes.len())
            .map_err(|_| unwritable("EXR", format!("attribute `{name}` is longer than 2 GiB; shorten it")))?;
        for part in [name.as_bytes(), &[0], kind, &[0], &length.to_le_bytes(), bytes] {
            inserted.extend_from_slice(part);
        }
        if name.len() >= 32 {
            file[5] |= LONG_NAMES;
        }
    }

    // Move the chunks: the table of their positions ends where the first of them begins.
    let start = header_end(&file)?;
    let table = file.get_mut(start..start + 8 * chunks).ok_or_else(|| damaged("EXR", "no chunk table"))?;
    for entry in table.chunks_exact_mut(8) {
        let position = entry.iter().rev().fold(0u64, |value, &byte| value << 8 | u64::from(byte));
        entry.copy_from_slice(&(position + inserted.len() as u64).to_le_bytes());
    }
    file.splice(PREAMBLE..PREAMBLE, inserted);
    Ok(file)
}

/// Names are null-terminated and at most 255 bytes long.
pub(crate) fn check_name(what: &str, name: &str) -> Result<()> {
    if name.is_empty() || name.len() > 255 || name.contains('\0') {
        return Err(unwritable("EXR", format!("{what} name `{name}` must have 1 to 255 bytes, none of them null")));
    }
    Ok(())
}

/// The position behind the null byte that ends the header.
fn header_end(file: &[u8]) -> Result<usize> {
    let cut = || damaged("EXR", "the header does not end");
    let mut at = PREAMBLE;
    while *file.get(at).ok_or_else(cut)? != 0 {
        for _name_then_type in 0..2 {
            at += file[at..].iter().position(|&byte| byte == 0).ok_or_else(cut)? + 1;
        }
        let length = file.get(at..at + 4).and_then(|bytes| bytes.try_into().ok()).ok_or_else(cut)?;
        at += 4 + u32::from_le_bytes(length) as usize;
    }
    Ok(at + 1)
}
