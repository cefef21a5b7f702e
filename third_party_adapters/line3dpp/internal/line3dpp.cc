#include "third_party_adapters/line3dpp/internal/line3dpp.h"

#include <utility>
#include <vector>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/scene/validation.h"
#include "third_party_adapters/internal/file_lines.h"
#include "third_party_adapters/internal/landmarks.h"
#include "third_party_adapters/internal/number_text.h"

namespace lowlap::line3dpp {
namespace {

/// The ends that are farthest apart along the first piece.
void SetExtent(const std::vector<Vec3>& ends, FileLine* line) {
  const Vec3 direction = ends[1] - ends[0];
  line->start = line->end = ends[0];
  for (const Vec3& end : ends) {
    if (direction.dot(end - line->start) < 0) line->start = end;
    if (direction.dot(end - line->end) > 0) line->end = end;
  }
}

void CheckLineGoesOn(TokenReader* reader) {
  if (reader->status() && reader->AtLineEnd()) {
    reader->Fail("the line ends before all that it announces");
  }
}

FileLine NextLine3dpp(std::size_t* num_joined, TokenReader* reader) {
  FileLine line;
  std::vector<Vec3> ends;
  const auto num_pieces =
      reader->Next<std::uint32_t>("the number of pieces of a line");
  for (std::uint32_t n = 0; n < num_pieces && reader->status(); ++n) {
    CheckLineGoesOn(reader);
    ends.push_back(NextVec3("a coordinate of a line", reader));
    ends.push_back(NextVec3("a coordinate of a line", reader));
  }
  if (reader->status() && (ends.empty() || ends[0] == ends[1])) {
    reader->Fail("the line has no length");
  }
  CheckLineGoesOn(reader);
  const auto num_segments =
      reader->Next<std::uint32_t>("the number of segments of a line");
  for (std::uint32_t n = 0; n < num_segments && reader->status(); ++n) {
    CheckLineGoesOn(reader);
    SupportingSegment segment;
    segment.view = reader->Next<std::uint32_t>("an image id");
    segment.number = reader->Next<std::uint32_t>("a segment id");
    segment.start_px = NextVec2("a coordinate of a segment", reader);
    segment.end_px = NextVec2("a coordinate of a segment", reader);
    line.support.push_back(segment);
  }
  if (reader->status() && !reader->AtLineEnd()) {
    reader->Fail("the line goes on after all that it announces");
  }
  if (!reader->status()) return line;
  SetExtent(ends, &line);
  if (num_pieces > 1) ++*num_joined;
  return line;
}

}  // namespace

bool IsLine3dppStart(std::string_view start) {
  TokenReader reader(start, {});
  std::size_t ignored = 0;
  return !NextLine3dpp(&ignored, &reader).support.empty() && reader.status();
}

Result<Scene> ParseLine3dpp(std::string_view text, const std::string& file,
                            SceneNotes* notes) {
  TokenReader reader(text, file);
  std::vector<FileLine> lines;
  std::size_t num_joined = 0;
  while (reader.status() && !reader.AtEnd()) {
    lines.push_back(NextLine3dpp(&num_joined, &reader));
  }
  if (!reader.status()) return reader.error();
  AddNote(num_joined, "lines of several pieces were joined", notes);
  Scene scene;
  LOWLAP_RETURN_IF_ERROR(AddFileLines(lines, &scene, notes));
  LOWLAP_RETURN_IF_ERROR(ValidateScene(scene));
  return scene;
}

Result<std::string> FormatLine3dpp(const Scene& scene, SceneNotes* notes) {
  LOWLAP_RETURN_IF_ERROR(ValidateScene(scene));
  LOWLAP_ASSIGN_OR_RETURN(const Scene undistorted,
                          UndistortedScene(scene, notes));
  std::string text;
  for (const FileLine& line : FileLinesOf(undistorted, notes)) {
    text += "1 " + NumberText(line.start) + " " + NumberText(line.end) + " " +
            std::to_string(line.support.size());
    for (const SupportingSegment& segment : line.support) {
      text += " " + std::to_string(segment.view.value()) + " " +
              std::to_string(segment.number) + " " +
              SegmentText(segment.start_px, segment.end_px);
    }
    text += "\n";
  }
  return text;
}

}  // namespace lowlap::line3dpp
