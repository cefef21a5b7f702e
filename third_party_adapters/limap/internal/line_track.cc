#include "third_party_adapters/limap/internal/line_track.h"

#include <set>

#include "third_party_adapters/internal/number_text.h"

namespace lowlap::limap {
namespace {

void NextKeyword(const char* keyword, TokenReader* reader) {
  const std::string_view word = reader->Word(keyword);
  if (reader->status() && word != keyword) {
    reader->Fail(std::string(keyword) + " is expected, not '" +
                 Escaped(std::string(word.substr(0, 32))) + "'");
  }
}

/// LIMAP's own bookkeeping of a track, which says nothing of the line.
void SkipNodes(std::size_t count, TokenReader* reader) {
  for (std::size_t n = 0; n < count && reader->status(); ++n) {
    reader->Next<std::int64_t>("a node id");
  }
  NextKeyword("score_list", reader);
  for (std::size_t n = 0; n < count && reader->status(); ++n) {
    reader->Next<double>("a score");
  }
  NextKeyword("line3d_list", reader);
  for (std::size_t n = 0; n < 2 * count && reader->status(); ++n) {
    NextVec3("a coordinate of a line", reader);
  }
  NextKeyword("END", reader);
}

std::string DecimalText(const double* values, int count) {
  std::string text;
  for (int n = 0; n < count; ++n) text += Format("%.10f ", values[n]);
  return text + "\n";
}

}  // namespace

Result<FileLine> ParseLineTrack(std::string_view text,
                                const std::string& file) {
  TokenReader reader(text, file);
  FileLine line;
  line.start = NextVec3("a coordinate of a line", &reader);
  line.end = NextVec3("a coordinate of a line", &reader);
  if (reader.status() && line.start == line.end) {
    reader.Fail("the line has no length");
  }
  const auto count = reader.Next<std::uint32_t>("the number of segments");
  reader.Next<std::uint32_t>("the number of images");
  NextKeyword("image_id_list", &reader);
  for (std::uint32_t n = 0; n < count && reader.status(); ++n) {
    line.support.emplace_back().view =
        reader.Next<std::uint32_t>("an image id");
  }
  NextKeyword("line_id_list", &reader);
  for (SupportingSegment& segment : line.support) {
    segment.number = reader.Next<std::uint32_t>("the number of a segment");
  }
  NextKeyword("line2d_list", &reader);
  for (SupportingSegment& segment : line.support) {
    segment.start_px = NextVec2("a coordinate of a segment", &reader);
    segment.end_px = NextVec2("a coordinate of a segment", &reader);
  }
  const std::string_view word = reader.Word("END");
  if (word == "node_id_list") {
    SkipNodes(line.support.size(), &reader);
  } else if (word != "END") {
    reader.Fail("END is expected after the segments");
  }
  if (!reader.status()) return reader.error();
  return line;
}

std::string FormatLineTrack(const FileLine& line) {
  std::set<ViewId> images;
  std::string image_ids, numbers, segments;
  for (const SupportingSegment& segment : line.support) {
    images.insert(segment.view);
    image_ids += std::to_string(segment.view.value()) + " ";
    numbers += std::to_string(segment.number) + " ";
    const Vec4 ends(segment.start_px.x(), segment.start_px.y(),
                    segment.end_px.x(), segment.end_px.y());
    segments += DecimalText(ends.data(), 4);
  }
  Eigen::Matrix<double, 6, 1> ends;
  ends << line.start, line.end;
  return DecimalText(ends.data(), 6) + std::to_string(line.support.size()) +
         " " + std::to_string(images.size()) + "\nimage_id_list " + image_ids +
         "\nline_id_list " + numbers + "\nline2d_list\n" + segments + "END\n";
}

}  // namespace lowlap::limap
