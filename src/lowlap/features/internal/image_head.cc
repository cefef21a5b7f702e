#include "lowlap/features/internal/image_head.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace lowlap {
namespace {

enum class ByteOrder { kBig, kLittle };

// The number in `count` bytes; 0 beyond the end of the file, where no size is.
std::uint32_t NumberAt(const std::string& bytes, std::size_t at, int count,
                       ByteOrder order) {
  if (at > bytes.size() || bytes.size() - at < static_cast<std::size_t>(count))
    return 0;
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i) {
    const int next = order == ByteOrder::kBig ? i : count - 1 - i;
    value = value << 8 | static_cast<std::uint8_t>(
                             bytes[at + static_cast<std::size_t>(next)]);
  }
  return value;
}

ImageSize SizeAt(const std::string& bytes, std::size_t width_at,
                 std::size_t height_at, int count, ByteOrder order) {
  return {static_cast<int>(NumberAt(bytes, width_at, count, order)),
          static_cast<int>(NumberAt(bytes, height_at, count, order))};
}

bool StartsWith(const std::string& bytes, std::string_view start) {
  return bytes.compare(0, start.size(), start) == 0;
}

// The header chunk IHDR is the first of a PNG file.
std::optional<ImageSize> PngSize(const std::string& bytes) {
  if (!StartsWith(bytes, "\x89PNG\r\n\x1a\n")) return std::nullopt;
  return SizeAt(bytes, 16, 20, 4, ByteOrder::kBig);
}

// Width and height of a BMP file with any of its usual headers; the height is
// negative where rows run from the top.
std::optional<ImageSize> BmpSize(const std::string& bytes) {
  if (!StartsWith(bytes, "BM")) return std::nullopt;
  ImageSize size = SizeAt(bytes, 18, 22, 4, ByteOrder::kLittle);
  if (size.height_px == INT32_MIN) return std::nullopt;
  size.height_px = std::abs(size.height_px);
  return size;
}

// A tag whose value is one number.
struct TiffTag {
  std::uint32_t name;
  std::size_t value_at;
  int value_size;
  ByteOrder order;
};

// Those of the first picture of a TIFF file.
std::optional<std::vector<TiffTag>> TiffTags(const std::string& bytes) {
  const bool is_little = StartsWith(bytes, {"II*\0", 4});
  if (!is_little && !StartsWith(bytes, {"MM\0*", 4})) return std::nullopt;
  const ByteOrder order = is_little ? ByteOrder::kLittle : ByteOrder::kBig;
  constexpr std::uint32_t kShort = 3, kLong = 4;
  std::vector<TiffTag> tags;
  const std::size_t start = NumberAt(bytes, 4, 4, order);
  const std::size_t count = NumberAt(bytes, start, 2, order);
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t at = start + 2 + 12 * n;
    const std::uint32_t type = NumberAt(bytes, at + 2, 2, order);
    if (type != kShort && type != kLong) continue;
    tags.push_back(
        {NumberAt(bytes, at, 2, order), at + 8, type == kShort ? 2 : 4, order});
  }
  return tags;
}

std::optional<ImageSize> TiffSize(const std::string& bytes) {
  const auto tags = TiffTags(bytes);
  if (!tags) return std::nullopt;
  constexpr std::uint32_t kWidth = 256, kHeight = 257;
  ImageSize size;
  for (const TiffTag& tag : *tags) {
    const auto value = static_cast<int>(
        NumberAt(bytes, tag.value_at, tag.value_size, tag.order));
    if (tag.name == kWidth) size.width_px = value;
    if (tag.name == kHeight) size.height_px = value;
  }
  return size;
}

std::optional<ImageSize> WebpSize(const std::string& bytes) {
  constexpr std::size_t kHeadSize = 30;
  if (!StartsWith(bytes, "RIFF") || bytes.size() < kHeadSize ||
      bytes.compare(8, 4, "WEBP") != 0) {
    return std::nullopt;
  }
  const std::string form = bytes.substr(12, 4);
  const auto number = [&](std::size_t at, int count) {
    return static_cast<int>(NumberAt(bytes, at, count, ByteOrder::kLittle));
  };
  if (form == "VP8X") return ImageSize{number(24, 3) + 1, number(27, 3) + 1};
  if (form == "VP8 ") {
    return ImageSize{number(26, 2) & 0x3fff, number(28, 2) & 0x3fff};
  }
  const auto packed = NumberAt(bytes, 21, 4, ByteOrder::kLittle);  // VP8L
  return ImageSize{static_cast<int>(packed & 0x3fff) + 1,
                   static_cast<int>(packed >> 14 & 0x3fff) + 1};
}

// "P1" to "P6", then width and height in decimal, with blanks, and comments up
// to the end of a line, between them.
std::optional<ImageSize> PnmSize(const std::string& bytes) {
  if (bytes.size() < 2 || bytes[0] != 'P' || bytes[1] < '1' || bytes[1] > '6') {
    return std::nullopt;
  }
  int values[2] = {0, 0};
  std::size_t at = 2;
  for (int& value : values) {
    for (;;) {
      at = std::min(bytes.find_first_not_of(" \t\r\n\v\f", at), bytes.size());
      if (at == bytes.size() || bytes[at] != '#') break;
      at = std::min(bytes.find('\n', at), bytes.size());
    }
    const char* end = bytes.data() + bytes.size();
    at = static_cast<std::size_t>(
        std::from_chars(bytes.data() + at, end, value).ptr - bytes.data());
  }
  return ImageSize{values[0], values[1]};
}

// Walks over the segments of a JPEG file, and over the coded data that follow
// each start of scan: an embedded thumbnail, with an end of its own, lies
// inside a segment.
std::optional<ImageHead> JpegHead(const std::string& bytes) {
  if (!StartsWith(bytes, "\xff\xd8")) return std::nullopt;
  const auto number = [&](std::size_t at, int count) {
    return NumberAt(bytes, at, count, ByteOrder::kBig);
  };
  ImageHead head;
  head.is_cut_off = true;
  std::size_t at = 2;
  while (at + 2 <= bytes.size()) {
    // Decoders skip what lies between two segments.
    at = bytes.find('\xff', at);
    if (at == std::string::npos || at + 2 > bytes.size()) return head;
    const std::uint32_t marker = number(at + 1, 1);
    // Fill bytes, what is no marker, and markers without a segment.
    if (marker == 0xff || marker <= 1 || (marker >= 0xd0 && marker <= 0xd7)) {
      ++at;
      continue;
    }
    if (marker == 0xd9) {
      head.is_cut_off = false;
      return head;
    }
    if (at + 4 > bytes.size()) return head;
    // C0..CF are frames, except for tables of Huffman codes (C4), arithmetic
    // conditioning (CC) and the reserved C8.
    if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 &&
        marker != 0xcc) {
      head.size = SizeAt(bytes, at + 7, at + 5, 2, ByteOrder::kBig);
    }
    at += 2 + number(at + 2, 2);
    if (marker != 0xda) continue;
    // Coded data: ff is followed by 00, or by a restart marker.
    for (; (at = bytes.find('\xff', at)) != std::string::npos; at += 2) {
      if (at + 2 > bytes.size()) return head;
      const std::uint32_t next = number(at + 1, 1);
      if (next != 0 && !(next >= 0xd0 && next <= 0xd7)) break;
    }
    if (at == std::string::npos) return head;
  }
  return head;
}

}  // namespace

std::optional<std::string> WithoutTiffOrientation(const std::string& bytes) {
  constexpr std::uint32_t kOrientation = 274;
  std::optional<std::string> upright;
  for (const TiffTag& tag : TiffTags(bytes).value_or(std::vector<TiffTag>{})) {
    if (tag.name != kOrientation || tag.value_size != 2 ||
        NumberAt(bytes, tag.value_at, 2, tag.order) <= 1) {
      continue;
    }
    if (!upright) upright = bytes;
    const bool is_big = tag.order == ByteOrder::kBig;
    (*upright)[tag.value_at] = is_big ? 0 : 1;
    (*upright)[tag.value_at + 1] = is_big ? 1 : 0;
  }
  return upright;
}

std::optional<ImageHead> ReadImageHead(const std::string& bytes) {
  std::optional<ImageHead> head = JpegHead(bytes);
  for (const auto size_of : {PngSize, TiffSize, BmpSize, WebpSize, PnmSize}) {
    if (head) break;
    if (const auto size = size_of(bytes)) head = ImageHead{*size, false};
  }
  if (!head || head->size.width_px <= 0 || head->size.height_px <= 0) {
    return std::nullopt;
  }
  return head;
}

}  // namespace lowlap
