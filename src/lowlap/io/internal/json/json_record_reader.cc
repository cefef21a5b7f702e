#include "lowlap/io/internal/json/json_record_reader.h"

#include <string>

namespace lowlap {
namespace {

// An enumeration by the name of its value.
template <class Kind>
void ReadName(const JsonValue& json, const char* what, Kind& value) {
  for (int n = 0; n <= static_cast<int>(LastOf(value)); ++n) {
    const auto each = static_cast<Kind>(n);
    if (json.String() == NameOf(each)) {
      value = each;
      return;
    }
  }
  json.Fail(what + std::string(" \"") + json.String() + "\" is not known");
}

}  // namespace

void Read(const JsonValue& json, std::vector<double>& value) {
  for (const JsonValue number : json.Elements()) {
    value.push_back(number.Real());
  }
}

void Read(const JsonValue& json, ViewPair& views) {
  if (json.FlatSize(1) != 2) json.Fail("must be two view ids");
  JsonFlatReader ids(json);
  ids.Item(views.first);
  ids.Item(views.second);
}

void Read(const JsonValue& json, ViewTriplet& views) {
  if (json.FlatSize(1) != 3) json.Fail("must be three view ids");
  JsonFlatReader ids(json);
  ids.Item(views.first);
  ids.Item(views.middle);
  ids.Item(views.last);
}

void Read(const JsonValue& json, CameraModel& model) {
  const std::optional<CameraModel> found = CameraModelFromName(json.String());
  if (!found) {
    json.Fail("camera model \"" + json.String() + "\" is not known",
              ErrorCode::kUnsupported);
  }
  model = *found;
}

void Read(const JsonValue& json, RatioVerdict& verdict) {
  ReadName(json, "verdict", verdict);
}

void Read(const JsonValue& json, PoseWeakness& weakness) {
  ReadName(json, "weakness", weakness);
}

}  // namespace lowlap
