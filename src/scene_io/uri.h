// SPDX-License-Identifier: Apache-2.0
// scene_io/uri.h: the URIs by which glTF files refer to buffers and images.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace nacre {

// Decodes each %XX to its byte (RFC 3986, 2.1). A % that begins no such code is kept.
std::string PercentDecoded(std::string_view text);

// Whether this is a data URI, which holds its data itself (RFC 2397).
bool IsDataUri(std::string_view uri);

// The bytes of a data URI, with or without a media type and parameters, in base64 (RFC 4648, with
// or without padding) or percent-encoded. nullopt if it is malformed.
std::optional<std::string> DecodeDataUri(std::string_view uri);

}  // namespace nacre
