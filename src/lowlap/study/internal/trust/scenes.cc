#include "lowlap/study/internal/trust/scenes.h"

#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/study/internal/trust/spoil.h"

namespace lowlap {
namespace {

template <class Value>
const Value& OneOf(const std::vector<Value>& values, Random* random) {
  return values[random->Index(static_cast<std::uint32_t>(values.size()))];
}

TrustScene DrawWrongDirections(Random* random) {
  TrustScene scene;
  SyntheticOptions& o = scene.options;
  using Kind = SyntheticKind;
  o.kind = OneOf<Kind>({Kind::kRoom, Kind::kRoom, Kind::kCorridor, Kind::kRing},
                       random);
  o.pairs = OneOf<std::string>(
      {"window:2", "window:2", "window:2", "chain", "cycle"}, random);
  o.num_views = OneOf<int>({6, 7, 8, 9, 10, 11}, random);
  o.points_per_wall = OneOf<int>({10, 20, 30}, random);
  o.lines_per_wall = OneOf<int>({20, 50}, random);
  o.noise_px = OneOf<double>({0.5, 1}, random);
  o.wrong_direction_share = OneOf<double>({0.1, 0.2}, random);
  return scene;
}

TrustScene DrawMixed(Random* random) {
  TrustScene scene;
  SyntheticOptions& o = scene.options;
  using Kind = SyntheticKind;
  o.kind = OneOf<Kind>(
      {Kind::kRoom, Kind::kRoom, Kind::kRoom, Kind::kCorridor, Kind::kRing,
       Kind::kPlanar, Kind::kCollinear, Kind::kTwins, Kind::kPureRotation},
      random);
  o.pairs = OneOf<std::string>({"window:2", "window:2", "window:2", "window:3",
                                "chain", "cycle", "loop:2", "all"},
                               random);
  o.num_views = OneOf<int>({6, 7, 8, 9, 10, 11}, random);
  o.points_per_wall = OneOf<int>({4, 10, 20, 30, 60}, random);
  o.lines_per_wall = OneOf<int>({20, 50, 100}, random);
  o.noise_px = OneOf<double>({0.5, 1}, random);
  o.trifocal_point_share = OneOf<double>({1, 1, 0.3, 0}, random);
  if (random->Uniform() < 0.3) {
    o.wrong_point_share = o.wrong_line_share = 0.1;
  }
  scene.estimates_poses = random->Uniform() < 0.3;
  if (random->Uniform() < 0.1) {
    scene.focal_factor = OneOf<double>({0.9, 0.97, 1.03, 1.1}, random);
    scene.estimates_poses = true;
  }
  if (scene.estimates_poses) return scene;
  o.pose_noise_factor = OneOf<double>({0, 1}, random);
  o.wrong_direction_share = OneOf<double>({0, 0.1, 0.2}, random);
  if (random->Uniform() < 0.1) o.wrong_pose_share = 0.1;
  scene.has_look_alikes = random->Uniform() < 0.15;
  return scene;
}

TrustScene DrawNoise(Random* random) {
  TrustScene scene;
  SyntheticOptions& o = scene.options;
  using Kind = SyntheticKind;
  o.kind = OneOf<Kind>({Kind::kRoom, Kind::kCorridor, Kind::kRing}, random);
  o.pairs = OneOf<std::string>({"window:2", "chain", "cycle"}, random);
  o.num_views = OneOf<int>({4, 5, 6, 7}, random);
  o.points_per_wall = OneOf<int>({4, 10, 20}, random);
  o.lines_per_wall = OneOf<int>({20, 50, 100}, random);
  o.noise_px = OneOf<double>({0.5, 1}, random);
  scene.features = OneOf<TrustScene::Features>(
      {TrustScene::Features::kShuffled, TrustScene::Features::kDrawn}, random);
  scene.estimates_poses = random->Uniform() < 0.25;
  return scene;
}

// What is matched by what looks the same has many features.
TrustScene DrawWalk(SyntheticKind kind, Random* random) {
  TrustScene scene;
  SyntheticOptions& o = scene.options;
  o.kind = kind;
  o.pairs = "all";
  o.num_views = OneOf<int>({10, 12, 14, 16}, random);
  o.points_per_wall = OneOf<int>({120, 240, 480}, random);
  o.lines_per_wall = OneOf<int>({20, 50}, random);
  o.noise_px = OneOf<double>({0.5, 1}, random);
  o.box_offset_m = OneOf<double>({0.3, 0.8}, random);
  return scene;
}

void LeaveOutViews(Random* random, TrustScene* scene) {
  for (int n = OneOf<int>({0, 2, 4}, random); n > 0; --n) {
    scene->left_out.emplace_back(
        random->Index(static_cast<std::uint32_t>(scene->options.num_views)));
  }
}

TrustScene DrawAlikeSides(Random* random) {
  TrustScene scene = DrawWalk(SyntheticKind::kHouse, random);
  scene.options.alike_share = OneOf<double>({0, 0.15, 0.3, 0.5}, random);
  scene.likeness.found_share = OneOf<double>({0.5, 0.8}, random);
  LeaveOutViews(random, &scene);
  return scene;
}

TrustScene DrawAlikeSections(Random* random) {
  TrustScene scene = DrawWalk(SyntheticKind::kCorridor, random);
  SyntheticOptions& o = scene.options;
  o.points_per_wall = OneOf<int>({30, 60, 120}, random);
  o.section_m = OneOf<double>({1.5, 2.5, 4}, random);
  o.box_offset_m = OneOf<double>({0.1, 0.3}, random);
  o.alike_share = OneOf<double>({0, 0.3, 0.6, 0.9}, random);
  scene.likeness.found_share = OneOf<double>({0.5, 0.8}, random);
  LeaveOutViews(random, &scene);
  return scene;
}

TrustScene DrawTwoSessions(Random* random) {
  using Kind = SyntheticKind;
  TrustScene scene =
      DrawWalk(OneOf<Kind>({Kind::kHouse, Kind::kRoom}, random), random);
  LikenessOptions& likeness = scene.likeness;
  likeness.found_share = OneOf<double>({0.5, 0.8}, random);
  likeness.changed_share = OneOf<double>({0.3, 0.5, 0.7}, random);
  // One after the other, or mixed along the way.
  const bool is_mixed = random->Uniform() < 0.5;
  for (int n = 0; n < scene.options.num_views; ++n) {
    const bool is_second =
        is_mixed ? random->Uniform() < 0.5 : n >= scene.options.num_views / 2;
    if (is_second) likeness.second_session.emplace_back(n);
  }
  LeaveOutViews(random, &scene);
  return scene;
}

}  // namespace

const char* TrustFamilyName(TrustFamily family) {
  switch (family) {
    case TrustFamily::kWrongDirections:
      return "wrong_directions";
    case TrustFamily::kMixed:
      return "mixed";
    case TrustFamily::kNoise:
      return "noise";
    case TrustFamily::kAlikeSides:
      return "alike_sides";
    case TrustFamily::kTwoSessions:
      return "two_sessions";
    case TrustFamily::kAlikeSections:
      return "alike_sections";
  }
  return "";
}

const std::vector<TrustFamily>& AllTrustFamilies() {
  static const std::vector<TrustFamily> families = {
      TrustFamily::kWrongDirections, TrustFamily::kMixed,
      TrustFamily::kAlikeSides,      TrustFamily::kAlikeSections,
      TrustFamily::kTwoSessions,     TrustFamily::kNoise};
  return families;
}

std::vector<std::string> TrustScene::Labels() const {
  std::vector<std::string> labels = {
      std::string("world ") + SyntheticKindName(options.kind),
      "pairs " + options.pairs};
  const std::size_t num_faultless = labels.size();
  const auto add_if = [&](bool is_so, const char* label) {
    if (is_so) labels.emplace_back(label);
  };
  add_if(options.wrong_direction_share > 0, "wrong directions");
  add_if(options.wrong_pose_share > 0, "wrong relative poses");
  add_if(options.wrong_point_share > 0, "wrong matches");
  add_if(has_look_alikes, "look-alikes");
  add_if(options.alike_share > 0, options.kind == SyntheticKind::kCorridor
                                      ? "alike sections"
                                      : "alike sides");
  add_if(likeness.changed_share > 0, "two sessions");
  add_if(!left_out.empty(), "missing views");
  add_if(focal_factor != 1, "wrong focal length");
  add_if(features == Features::kShuffled, "shuffled features");
  add_if(features == Features::kDrawn, "unrelated views");
  add_if(labels.size() == num_faultless, "nothing wrong");
  add_if(estimates_poses, "relative poses from matches");
  return labels;
}

TrustScene DrawTrustScene(TrustFamily family, std::uint64_t seed) {
  Random random(seed, static_cast<std::uint64_t>(family));
  const auto draw = [&] {
    switch (family) {
      case TrustFamily::kWrongDirections:
        return DrawWrongDirections(&random);
      case TrustFamily::kMixed:
        return DrawMixed(&random);
      case TrustFamily::kNoise:
        return DrawNoise(&random);
      case TrustFamily::kAlikeSides:
        return DrawAlikeSides(&random);
      case TrustFamily::kTwoSessions:
        return DrawTwoSessions(&random);
      case TrustFamily::kAlikeSections:
        return DrawAlikeSections(&random);
    }
    return TrustScene();
  };
  TrustScene scene = draw();
  scene.options.seed = seed;
  return scene;
}

Result<SyntheticScene> MakeTrustScene(const TrustScene& drawn,
                                      const RunContext& context) {
  LOWLAP_ASSIGN_OR_RETURN(auto made, Simulate(drawn.options));
  // A stream that nothing else draws from.
  constexpr std::uint64_t kStream = 100;
  Random random(drawn.options.seed, kStream);
  if (drawn.has_look_alikes) {
    constexpr int kPoints = 40;
    AddLookAlikes(kPoints, drawn.options.noise_px, &random, &made.scene);
  }
  if (drawn.features == TrustScene::Features::kShuffled) {
    ShuffleFeatures(&random, &made.scene);
  } else if (drawn.features == TrustScene::Features::kDrawn) {
    DrawFeatures(&random, &made.scene);
  }
  for (auto& entry : made.scene.intrinsics) {
    entry.second.fx_px *= drawn.focal_factor;
    entry.second.fy_px *= drawn.focal_factor;
  }
  if (drawn.likeness.found_share < 1) {
    const auto detected =
        DescribeFeatures(made, drawn.likeness, drawn.options.seed);
    made.scene = WithoutViews(made.scene, drawn.left_out);
    LOWLAP_RETURN_IF_ERROR(MatchAnew(detected, context, &made.scene));
  } else if (drawn.estimates_poses) {
    LOWLAP_RETURN_IF_ERROR(EstimatePosesAnew(context, &made.scene));
  }
  return made;
}

}  // namespace lowlap
