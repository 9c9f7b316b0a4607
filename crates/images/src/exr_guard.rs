//! What an EXR file may not claim. Checked before its samples are decoded, since the `exr` crate takes memory on
//! the word of a header, and of the small headers within DWA chunks.

use crate::error::{ImageError, Result, damaged};
use crate::limits::check_size;
use exr::block::chunk::CompressedBlock;
use exr::meta::BlockDescription;
use exr::meta::header::Header;
use exr::prelude as x;
use std::collections::BTreeSet;
use std::io::Cursor;

/// Beyond any tile in use; larger ones would only overflow arithmetic.
const LARGEST_TILE: usize = 1 << 13;

/// Refuse what is not supported and what cannot be true.
pub(crate) fn check_claims(parts: &[Header], bytes: &[u8]) -> Result<()> {
    let mut bytes_per_pixel = 0;
    for part in parts {
        check_features(part)?;
        if (part.own_attributes.layer_position, part.layer_size)
            != (parts[0].own_attributes.layer_position, parts[0].layer_size)
        {
            return unsupported("parts with different data windows", "split it with `exrmultipart -separate`");
        }
        let sizes = part.channels.list.iter().map(|channel| channel.sample_type.bytes_per_sample() as u64);
        bytes_per_pixel += sizes.sum::<u64>();
        check_size("EXR", [part.layer_size.0 as u64, part.layer_size.1 as u64], bytes_per_pixel, bytes.len())?;
    }
    // Each chunk needs at least its place in the table, so a short file has few.
    let chunks = parts.iter().fold(0usize, |sum, part| sum.saturating_add(part.chunk_count));
    if chunks > bytes.len() / 8 {
        return Err(damaged("EXR", format!("{} bytes cannot hold {chunks} chunks", bytes.len())));
    }
    check_chunks(bytes)
}

pub(crate) fn translate(error: x::Error) -> ImageError {
    match error {
        x::Error::NotSupported(what) => ImageError::Unsupported {
            format: "EXR",
            what: what.into_owned(),
            cure: "save it again as flat scan lines with ZIP compression",
        },
        other => damaged("EXR", other),
    }
}

fn check_features(part: &Header) -> Result<()> {
    if part.deep {
        return unsupported("deep samples", "flatten it in a compositor");
    }
    // The decoder of exr 1.74 overflows on damaged B44 blocks.
    if matches!(part.compression, x::Compression::B44 | x::Compression::B44A) {
        return unsupported("B44 compression", "save it again with ZIP or PIZ compression");
    }
    if let BlockDescription::Tiles(tiles) = part.blocks
        && tiles.tile_size.0.max(tiles.tile_size.1) > LARGEST_TILE
    {
        let x::Vec2(width, height) = tiles.tile_size;
        return Err(damaged("EXR", format!("tiles of {width} x {height} pixels")));
    }
    if let Some(channel) = part.channels.list.iter().find(|channel| channel.sampling != x::Vec2(1, 1)) {
        let what = format!("a subsampled channel, `{}`", channel.name);
        return unsupported(what, "save it again with full-resolution RGB channels");
    }
    Ok(())
}

/// Each chunk says itself where it belongs: two in one place, or one on another level, would leave a hole.
fn check_chunks(bytes: &[u8]) -> Result<()> {
    let full_size = x::Vec2(0, 0);
    let reader = exr::block::read(Cursor::new(bytes), false).map_err(translate)?;
    let parts: Vec<Header> = reader.headers().to_vec();
    let chunks = reader.filter_chunks(false, |_, tile, _| tile.level_index == full_size).map_err(translate)?;
    let mut seen = BTreeSet::new();
    for chunk in chunks {
        let chunk = chunk.map_err(translate)?;
        let part = parts.get(chunk.layer_index).ok_or_else(|| damaged("EXR", "a chunk belongs to no part"))?;
        let place = part.get_block_data_indices(&chunk.compressed_block).map_err(translate)?;
        if place.level_index != full_size || !seen.insert((chunk.layer_index, place.tile_index.0, place.tile_index.1)) {
            return Err(damaged("EXR", "its chunks are in the wrong places"));
        }
        let block = part.get_absolute_block_pixel_coordinates(place).map_err(translate)?;
        if matches!(part.compression, x::Compression::DWAA(_) | x::Compression::DWAB(_)) {
            check_dwa_chunk(&chunk.compressed_block, block.size.area() * part.channels.bytes_per_pixel)?;
        }
    }
    Ok(())
}

/// A DWA chunk begins with eleven counters of 64 bits. All but the first and the last are lengths of what it
/// unpacks to or from, each at most about the size of the block.
fn check_dwa_chunk(chunk: &CompressedBlock, unpacked: usize) -> Result<()> {
    let packed = match chunk {
        CompressedBlock::ScanLine(block) => &block.compressed_pixels_le,
        CompressedBlock::Tile(block) => &block.compressed_pixels_le,
        _ => return Ok(()),
    };
    let too_long = |entry: &[u8]| {
        let length = u64::from_le_bytes(entry.try_into().unwrap_or_default());
        length > 4 * unpacked as u64 + 0x10000
    };
    // A block that did not shrink is kept as it is, without counters.
    if packed.len() != unpacked && packed.chunks_exact(8).skip(1).take(9).any(too_long) {
        return Err(damaged("EXR", "a DWA block claims to be larger than it can be"));
    }
    Ok(())
}

fn unsupported(what: impl Into<String>, cure: &'static str) -> Result<()> {
    Err(ImageError::Unsupported { format: "EXR", what: what.into(), cure })
}
