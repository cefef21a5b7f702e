#include "third_party_adapters/onedsfm/internal/problem_files.h"

#include <charconv>
#include <cmath>

#include "third_party_adapters/internal/number_text.h"

namespace lowlap::onedsfm {
namespace {

constexpr double kMaxHalfSizePx = 1e9;  // twice it is an int

// The value of `name = value` in a header of coords.txt, up to `end`; empty if
// there is none.
std::string_view FieldOf(std::string_view line, std::string_view name,
                         std::string_view end) {
  const std::size_t start = line.find(name);
  if (start == std::string_view::npos) return {};
  const std::string_view rest = line.substr(start + name.size());
  return end.empty() ? rest : rest.substr(0, rest.find(end));
}

template <class T>
bool ParseField(std::string_view field, T* value) {
  const char* end = field.data() + field.size();
  const auto [stop, error] = std::from_chars(field.data(), end, *value);
  return error == std::errc() && stop == end && !field.empty();
}

}  // namespace

Result<std::vector<RelativeGeometry>> ParseGeometries(std::string_view text,
                                                      const std::string& file) {
  TokenReader reader(text, file);
  std::vector<RelativeGeometry> geometries;
  while (reader.status() && !reader.AtEnd()) {
    RelativeGeometry geometry;
    geometry.i = reader.Next<ImageIndex>("an image index");
    geometry.j = reader.Next<ImageIndex>("an image index");
    geometry.rotation = NextRotation("images " + std::to_string(geometry.i) +
                                         " and " + std::to_string(geometry.j),
                                     &reader);
    geometry.direction = NextVec3("a number of the direction", &reader);
    if (!reader.status()) break;
    if (geometry.i == geometry.j) {
      reader.Fail("image " + std::to_string(geometry.i) +
                  " is paired with itself");
      break;
    }
    const double length = geometry.direction.norm();
    if (!(length > 0) || !std::isfinite(length)) {
      reader.Fail("the direction of images " + std::to_string(geometry.i) +
                  " and " + std::to_string(geometry.j) + " has no length");
      break;
    }
    geometry.direction.normalize();
    geometries.push_back(geometry);
  }
  if (!reader.status()) return reader.error();
  return geometries;
}

Result<std::vector<ImageIndex>> ParseIndices(std::string_view text,
                                             const std::string& file) {
  TokenReader reader(text, file);
  std::vector<ImageIndex> indices;
  while (reader.status() && !reader.AtEnd()) {
    indices.push_back(reader.Next<ImageIndex>("an image index"));
  }
  if (!reader.status()) return reader.error();
  return indices;
}

Result<std::map<ImageIndex, ImageKeys>> ParseCoords(std::string_view text,
                                                    const std::string& file) {
  TokenReader reader(text, file);
  std::map<ImageIndex, ImageKeys> images;
  while (reader.status() && !reader.AtEnd()) {
    const std::string_view line = reader.RestOfLine();
    ImageIndex index = 0;
    ImageKeys image;
    std::size_t num_keys = 0;
    const bool is_header =
        line.substr(0, 1) == "#" &&
        ParseField(FieldOf(line, "index = ", ","), &index) &&
        ParseField(FieldOf(line, "keys = ", ","), &num_keys) &&
        ParseField(FieldOf(line, "px = ", ","), &image.half_size_px.x()) &&
        ParseField(FieldOf(line, "py = ", ","), &image.half_size_px.y()) &&
        ParseField(FieldOf(line, "focal = ", ""), &image.focal_px) &&
        (image.half_size_px.array() >= 0).all() &&
        (image.half_size_px.array() <= kMaxHalfSizePx).all() &&
        std::isfinite(image.focal_px);
    if (!is_header) {
      reader.Fail(
          "'#index = I, name = N, keys = K, px = X, py = Y, focal = F' is "
          "expected, not '" +
          std::string(line.substr(0, 60)) + "'");
      break;
    }
    image.name = std::string(FieldOf(line, "name = ", ", keys = "));
    if (!IsUtf8(image.name)) {
      reader.Fail("the name '" + Escaped(image.name) + "' is not UTF-8");
    }
    for (std::size_t k = 0; k < num_keys && reader.status(); ++k) {
      if (reader.Next<std::size_t>("a keypoint index") != k) {
        reader.Fail("keypoint " + std::to_string(k) + " of image " +
                    std::to_string(index) + " is expected");
      }
      const double x = reader.Next<double>("x of a keypoint");
      const double y = reader.Next<double>("y of a keypoint");
      reader.RestOfLine();  // 0 0 r g b
      image.keys_px.emplace_back(x, y);
    }
    if (!reader.status()) break;
    if (!images.emplace(index, std::move(image)).second) {
      reader.Fail("image " + std::to_string(index) + " is listed twice");
    }
  }
  if (!reader.status()) return reader.error();
  return images;
}

Result<std::vector<KeyTrack>> ParseTracks(std::string_view text,
                                          const std::string& file) {
  TokenReader reader(text, file);
  const auto num_tracks = reader.Next<std::size_t>("the number of tracks");
  std::vector<KeyTrack> tracks;
  for (std::size_t t = 0; t < num_tracks && reader.status(); ++t) {
    const auto length = reader.Next<std::size_t>("the length of a track");
    KeyTrack track;
    for (std::size_t n = 0; n < length && reader.status(); ++n) {
      const auto image = reader.Next<ImageIndex>("an image index");
      const auto key = reader.Next<std::uint32_t>("a keypoint index");
      track.emplace_back(image, key);
    }
    tracks.push_back(std::move(track));
  }
  if (reader.status() && !reader.AtEnd()) {
    reader.Fail("more than the " + std::to_string(num_tracks) +
                " tracks that the first line announces");
  }
  if (!reader.status()) return reader.error();
  return tracks;
}

}  // namespace lowlap::onedsfm
