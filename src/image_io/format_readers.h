// SPDX-License-Identifier: Apache-2.0
// image_io/format_readers.h: readers of one format each, in exr_reader.cc, png_reader.cc,
// jpeg_reader.cc, webp_reader.cc, hdr_reader.cc, pnm_reader.cc, tga_reader.cc and oiio.cc.
#pragma once

#include <string>
#include <vector>

#include "image_io/image_file.h"

namespace nacre {

// With OpenEXR, opens the scanline and tiled parts of a file (at full resolution, if they have
// several): all channels as floats, ids included, and the headers' attributes as text. Deep parts
// and parts with subsampled channels (luminance and chroma) have a refusal, which is thrown if such
// a part would be read.
//
// Damaged files are refused: missing chunks, chunks of a wrong size, and chunks that cannot be
// decoded. Besides the caller's samples, reading takes memory for a chunk or a row of tiles, which
// is limited like the samples of an image.
//
// `part` and the errors are explained at OpenImage.
ImageFile OpenExr(const std::string& path, const std::string& part = {});

std::vector<ImagePart> DescribeExr(const std::string& path);

// With libspng, opens any PNG file; channels Y, Y A, R G B or R G B A, for palettes those of their
// colours. EXIF's orientation is honoured. Besides the caller's samples, reading takes memory for
// two rows, or for the whole image in the file's own type if it is interlaced. Throws Error
// (kBadInput) for broken files.
//
// Metadata: texts (tEXt, zTXt, iTXt) under their keywords, those that are not nacre's own as
// "png:KEYWORD"; "gamma" (gAMA: the encoding exponent), "primaries" (cHRM), "icc_profile" (iCCP:
// its name, or "sRGB"), "srgb_intent", "code_points" (cICP); and "not_srgb", which says in words
// how these contradict sRGB.
ImageFile OpenPng(const std::string& path);

// With libjpeg-turbo, opens baseline and progressive JPEG files of 8 bits per sample; channels Y or
// R G B. CMYK is converted as Adobe's programs store it. EXIF's orientation is honoured; metadata:
// "icc_profile" (its name, or "sRGB") and "not_srgb" (why not, in words). Besides the caller's
// samples, reading takes memory for a row, or for the coefficients of a progressive file, two bytes
// each. Throws Error (kBadInput) for broken files: pixels that the library would make up are
// refused.
ImageFile OpenJpeg(const std::string& path);

// With libwebp, opens lossy and lossless WebP files; channels R G B, and A if the file says that it
// has alpha. Animations are refused. EXIF's orientation is honoured; metadata: "icc_profile" and
// "not_srgb" as of JPEG. Besides the caller's samples, reading takes memory for the file and for
// the whole image in bytes. Throws Error (kBadInput) for broken files.
ImageFile OpenWebp(const std::string& path);

// Opens a Radiance file of RGBE or XYZE pixels, whose rows may be plain, run-length encoded, or use
// the repetitions of the oldest files (Ward 1991, "Real Pixels", and RADIANCE's
// ray/src/common/color.c and resolu.c). Channels R G B, metadata["transfer"] = "linear", and the
// header's variables as metadata.
//
// The header is honoured: all eight orientations of the resolution string; EXPOSURE and COLORCORR
// (each may occur several times, and multiplies) are divided out, so that values are radiance. XYZE
// pixels are converted as by ra_xyze -r. PRIMARIES other than Radiance's own become the metadata
// "chromaticities". PIXASPECT, which multiplies as well, becomes pixelAspectRatio, its reciprocal.
// FORMAT may be missing: RADIANCE's own programs take such files as RGBE, too.
//
// Throws Error (kBadInput) for GAMMA other than 1, and for a broken file.
ImageFile OpenHdr(const std::string& path);

// Opens the first image of a portable pixel map of Netpbm, or PFM. P1 to P6: bits, greys and
// colours, as text or binary, with any maximum up to 65535; display values. Pf and PF: grey or
// colour floats in either byte order, with rows from the bottom up, multiplied by the header's
// scale; linear values. Channels Y or R G B.
//
// Throws Error (kBadInput) for files that are cut off or contradict their header. This reader
// exists because Netpbm's own library ends the process on such a file, and OpenImageIO makes up
// what is missing.
ImageFile OpenPnm(const std::string& path);

// Opens Truevision TGA files with palettes, colours of 15, 16, 24 and 32 bits, or greys of 8 bits;
// uncompressed or run-length encoded, starting at any corner (Truevision TGA File Format
// Specification, version 2.0). Channels Y, R G B or R G B A, with alpha if the descriptor counts
// alpha bits. Display values.
//
// Throws Error (kBadInput) for other kinds and for broken files. This reader exists because
// OpenImageIO 2.4 reads out of bounds where an index is beyond the palette, and Debian has no other
// library for the format that is made for untrusted files.
ImageFile OpenTga(const std::string& path);

// Whether the module exists by which OpenWithOiio reads.
bool HasOiio();

// With OpenImageIO, opens a TIFF file, with the results and errors of OpenImage: the first page at
// full resolution. Rows are decoded in bands: besides the caller's samples, reading takes memory
// for a band, and what OpenImageIO and libtiff allocate. Orientation tags are honoured.
ImageFile OpenWithOiio(const std::string& path);

// What the first image of a TIFF file (TIFF 6.0 and BigTIFF) lacks of the data of its pixels, in
// words; "" if nothing. libtiff would silently make it up: it takes palette indices without a
// palette for grey, and reads beyond the end of uncompressed strips that are too short.
std::string WhatTiffLacks(const std::string& path);

}  // namespace nacre
