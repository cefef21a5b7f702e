#include <charconv>
#include <map>

#include "lowlap/core/internal/format.h"
#include "lowlap/io/internal/failure.h"
#include "third_party_adapters/colmap/internal/model.h"

namespace lowlap::colmap {
namespace {

/// The words of a text, line by line; what is wrong is thrown as a Failure.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  /// Goes to the next line, whatever it holds; false at the end of the text.
  bool Next() {
    if (text_.empty()) return false;
    const std::size_t end = text_.find('\n');
    line_ = text_.substr(0, end);
    text_.remove_prefix(end == text_.npos ? text_.size() : end + 1);
    ++number_;
    return true;
  }
  /// The same, past comments and lines without a word.
  bool NextEntry() {
    while (Next()) {
      if (!AtEnd() && line_[0] != '#') return true;
    }
    return false;
  }
  bool AtEnd() {
    line_.remove_prefix(
        std::min(line_.find_first_not_of(" \t\r"), line_.size()));
    return line_.empty();
  }
  std::string_view Word(const char* what) {
    if (AtEnd())
      Fail(std::string("the line ends where ") + what + " is expected");
    const std::size_t end =
        std::min(line_.find_first_of(" \t\r"), line_.size());
    const std::string_view word = line_.substr(0, end);
    line_.remove_prefix(end);
    return word;
  }
  /// Of reals, NaN too: that is what a place that is not known is written as.
  template <class T>
  void Number(const char* what, T* value) {
    const std::string_view word = Word(what);
    const auto [stop, error] =
        std::from_chars(word.data(), word.data() + word.size(), *value);
    if (error == std::errc() && stop == word.data() + word.size()) return;
    Fail("'" + Escaped(std::string(word.substr(0, 32))) + "' is not " + what);
  }
  template <class Vector>
  void Reals(const char* what, Vector* values) {
    for (double& value : *values) Number(what, &value);
  }
  void Pose(FilePose* pose) {
    for (double& value : pose->rotation) Number("a quaternion", &value);
    for (double& value : pose->translation) Number("a translation", &value);
  }
  [[noreturn]] void Fail(const std::string& message,
                         ErrorCode code = ErrorCode::kParse) const {
    throw Failure{Error{code, message, {}, "line " + std::to_string(number_)}};
  }

 private:
  std::string_view text_;
  std::string_view line_;
  std::size_t number_ = 0;
};

const std::map<std::string_view, std::int32_t> kSensorTypes = {
    {"CAMERA", 0}, {"IMU", 1}, {"INVALID", -1}};

Sensor ReadSensor(Lines& lines) {
  Sensor sensor;
  const auto type = kSensorTypes.find(lines.Word("a sensor type"));
  if (type == kSensorTypes.end()) {
    lines.Fail("a sensor is CAMERA, IMU or INVALID");
  }
  sensor.type = type->second;
  lines.Number("a sensor id", &sensor.id);
  return sensor;
}

std::string Text(const Sensor& sensor) {
  for (const auto& [name, type] : kSensorTypes) {
    if (type == sensor.type) {
      return std::string(name) + " " + std::to_string(sensor.id);
    }
  }
  return "INVALID " + std::to_string(sensor.id);
}

template <class Values>
std::string Text(const Values& values) {
  std::string text;
  for (const double value : values) text += Format(" %.17g", value);
  return text.substr(1);
}

std::string Text(const FilePose& pose) {
  return Text(pose.rotation) + " " + Text(pose.translation);
}

Camera ReadCamera(Lines& lines) {
  Camera camera;
  lines.Number("a camera id", &camera.id);
  const std::string name(lines.Word("a camera model"));
  const auto model = ModelFromName(name);
  if (!model) {
    lines.Fail("camera " + std::to_string(camera.id) + " has model " +
                   Escaped(name) + ", which is not known",
               ErrorCode::kUnsupported);
  }
  camera.model = *model;
  lines.Number("a width", &camera.width_px);
  lines.Number("a height", &camera.height_px);
  camera.params.resize(*ParameterCount(*model));
  lines.Reals("a parameter", &camera.params);
  if (!lines.AtEnd()) lines.Fail(name + " has fewer parameters");
  return camera;
}

Image ReadImage(Lines& lines) {
  Image image;
  lines.Number("an image id", &image.id);
  lines.Pose(&image.cam_from_world);
  lines.Number("a camera id", &image.camera_id);
  image.name = lines.Word("an image name");
  if (!lines.AtEnd()) lines.Fail("an image name holds no blanks");
  if (!lines.Next()) lines.Fail("the second line of the image is missing");
  while (!lines.AtEnd()) {
    Point2D& point = image.points.emplace_back();
    lines.Reals("a pixel", &point.pixel_px);
    std::int64_t id = 0;
    lines.Number("the id of a point", &id);
    point.point3d = static_cast<std::uint64_t>(id);
  }
  return image;
}

Point3D ReadPoint(Lines& lines) {
  Point3D point;
  lines.Number("the id of a point", &point.id);
  lines.Reals("a position", &point.position);
  for (std::uint8_t& channel : point.color) lines.Number("a colour", &channel);
  lines.Number("an error", &point.error_px);
  while (!lines.AtEnd()) {
    TrackElement& element = point.track.emplace_back();
    lines.Number("an image id", &element.image_id);
    lines.Number("the index of a point", &element.point_index);
  }
  return point;
}

Rig ReadRig(Lines& lines) {
  Rig rig;
  std::uint32_t count = 0;
  lines.Number("a rig id", &rig.id);
  lines.Number("a number of sensors", &count);
  for (std::uint32_t n = 0; n < count; ++n) {
    RigSensor& sensor = rig.sensors.emplace_back();
    sensor.sensor = ReadSensor(lines);
    int has_pose = 0;
    if (n > 0) lines.Number("0 or 1", &has_pose);
    if (has_pose != 0) lines.Pose(&sensor.sensor_from_rig.emplace());
  }
  return rig;
}

Frame ReadFrame(Lines& lines) {
  Frame frame;
  std::uint32_t count = 0;
  lines.Number("a frame id", &frame.id);
  lines.Number("a rig id", &frame.rig_id);
  lines.Pose(&frame.rig_from_world);
  lines.Number("a number of images", &count);
  for (std::uint32_t n = 0; n < count; ++n) {
    FrameData& data = frame.data.emplace_back();
    data.sensor = ReadSensor(lines);
    lines.Number("an image id", &data.data_id);
  }
  return frame;
}

std::string Line(const Camera& camera) {
  return std::to_string(camera.id) + " " + ModelName(camera.model) + " " +
         std::to_string(camera.width_px) + " " +
         std::to_string(camera.height_px) + " " + Text(camera.params) + "\n";
}

std::string Line(const Image& image) {
  std::string text = std::to_string(image.id) + " " +
                     Text(image.cam_from_world) + " " +
                     std::to_string(image.camera_id) + " " + image.name + "\n";
  for (const Point2D& point : image.points) {
    if (text.back() != '\n') text += ' ';
    text += Text(point.pixel_px) + " " +
            std::to_string(static_cast<std::int64_t>(point.point3d));
  }
  return text + "\n";
}

std::string Line(const Point3D& point) {
  std::string text = std::to_string(point.id) + " " + Text(point.position);
  for (const std::uint8_t channel : point.color) {
    text += " " + std::to_string(channel);
  }
  text += Format(" %.17g", point.error_px);
  for (const TrackElement& element : point.track) {
    text += " " + std::to_string(element.image_id) + " " +
            std::to_string(element.point_index);
  }
  return text + "\n";
}

std::string Line(const Rig& rig) {
  std::string text =
      std::to_string(rig.id) + " " + std::to_string(rig.sensors.size());
  for (std::size_t n = 0; n < rig.sensors.size(); ++n) {
    const RigSensor& sensor = rig.sensors[n];
    text += " " + Text(sensor.sensor);
    if (n == 0) continue;
    text +=
        sensor.sensor_from_rig ? " 1 " + Text(*sensor.sensor_from_rig) : " 0";
  }
  return text + "\n";
}

std::string Line(const Frame& frame) {
  std::string text =
      std::to_string(frame.id) + " " + std::to_string(frame.rig_id) + " " +
      Text(frame.rig_from_world) + " " + std::to_string(frame.data.size());
  for (const FrameData& data : frame.data) {
    text += " " + Text(data.sensor) + " " + std::to_string(data.data_id);
  }
  return text + "\n";
}

template <class Read, class Item>
void ReadAll(Lines& lines, const Read& read, std::vector<Item>* items) {
  while (lines.NextEntry()) items->push_back(read(lines));
}

template <class Item>
std::string AllLines(const char* columns, const std::vector<Item>& items) {
  std::string text = std::string("# ") + columns + "\n";
  for (const Item& item : items) text += Line(item);
  return text;
}

}  // namespace

void ParseText(std::string_view text, const std::string& name, Model* model) {
  Lines lines(text);
  if (name == "cameras") {
    ReadAll(lines, ReadCamera, &model->cameras);
  } else if (name == "images") {
    ReadAll(lines, ReadImage, &model->images);
  } else if (name == "points3D") {
    ReadAll(lines, ReadPoint, &model->points);
  } else if (name == "rigs") {
    ReadAll(lines, ReadRig, &model->rigs);
  } else {
    ReadAll(lines, ReadFrame, &model->frames);
  }
}

std::string FormatText(const Model& model, const std::string& name) {
  if (name == "cameras") {
    return AllLines("CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]", model.cameras);
  }
  if (name == "images") {
    return AllLines(
        "IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
        "# POINTS2D[] as (X, Y, POINT3D_ID)",
        model.images);
  }
  if (name == "points3D") {
    return AllLines(
        "POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, "
        "POINT2D_IDX)",
        model.points);
  }
  if (name == "rigs") {
    return AllLines(
        "RIG_ID, NUM_SENSORS, REF_SENSOR_TYPE, REF_SENSOR_ID, SENSORS[] as "
        "(SENSOR_TYPE, SENSOR_ID, HAS_POSE, [QW, QX, QY, QZ, TX, TY, TZ])",
        model.rigs);
  }
  return AllLines(
      "FRAME_ID, RIG_ID, RIG_FROM_WORLD[QW, QX, QY, QZ, TX, TY, TZ], "
      "NUM_DATA_IDS, DATA_IDS[] as (SENSOR_TYPE, SENSOR_ID, DATA_ID)",
      model.frames);
}

}  // namespace lowlap::colmap
