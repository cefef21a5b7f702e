#include "lowlap/io/internal/json/json_record_reader.h"

namespace lowlap {

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
  for (const RatioVerdict each :
       {RatioVerdict::kMeaningful, RatioVerdict::kNotMeaningful,
        RatioVerdict::kNoCandidates}) {
    if (json.String() == RatioVerdictName(each)) {
      verdict = each;
      return;
    }
  }
  json.Fail("verdict \"" + json.String() + "\" is not known");
}

}  // namespace lowlap
