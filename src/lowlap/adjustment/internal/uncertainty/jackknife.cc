#include "lowlap/adjustment/internal/uncertainty/jackknife.h"

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

#include "lowlap/adjustment/internal/rounds/problem_selection.h"
#include "lowlap/adjustment/internal/rounds/solve.h"
#include "lowlap/adjustment/internal/uncertainty/center_shift.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

constexpr int kNumGroups = 8;
constexpr int kHalvings = 6;  // to 64 patches
// Weak modes of the scene, which matter here, converge last.
constexpr double kWeakModeTolerance = 1e-5;

struct PlacedLandmark {
  bool is_line = false;
  int index = -1;  // into StructureState::points or lines
  Vec3 place = Vec3::Zero();
};

// The group of every point and line of the state; -1 if it is in none.
struct Groups {
  std::vector<int> of_points;
  std::vector<int> of_lines;
};

// Halves the landmarks where they spread most, again and again; the patches go
// to the groups in turn.
class PatchDivision {
 public:
  explicit PatchDivision(Groups* groups) : groups_(groups) {}

  void Divide(PlacedLandmark* begin, PlacedLandmark* end, int halvings) {
    if (halvings == 0 || end - begin < 2) {
      for (const PlacedLandmark* landmark = begin; landmark != end;
           ++landmark) {
        (landmark->is_line ? groups_->of_lines
                           : groups_->of_points)[landmark->index] =
            patch_count_ % kNumGroups;
      }
      ++patch_count_;
      return;
    }
    const int axis = AxisOfSpread(begin, end);
    PlacedLandmark* const middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end,
                     [axis](const PlacedLandmark& a, const PlacedLandmark& b) {
                       return a.place[axis] < b.place[axis];
                     });
    Divide(begin, middle, halvings - 1);
    Divide(middle, end, halvings - 1);
  }

 private:
  static int AxisOfSpread(const PlacedLandmark* begin,
                          const PlacedLandmark* end) {
    const auto count = static_cast<double>(end - begin);
    Vec3 mean = Vec3::Zero();
    for (const PlacedLandmark* l = begin; l != end; ++l) {
      mean += l->place / count;
    }
    Vec3 spread = Vec3::Zero();
    for (const PlacedLandmark* l = begin; l != end; ++l) {
      spread += (l->place - mean).cwiseAbs();
    }
    int axis = 0;
    spread.maxCoeff(&axis);
    return axis;
  }

  Groups* groups_;
  int patch_count_ = 0;
};

// In the frames of the components, so that the world's has no influence.
Groups MakeGroups(const std::vector<Component>& components, CameraSet cameras,
                  StructureState state) {
  EnterComponentFrames(components, &cameras, &state);
  Groups groups{std::vector<int>(state.points.size(), -1),
                std::vector<int>(state.lines.size(), -1)};
  for (const Component& component : components) {
    std::vector<PlacedLandmark> landmarks;
    for (const int n : component.points) {
      landmarks.push_back({false, n, state.points[n].position});
    }
    for (const int n : component.lines) {
      landmarks.push_back({true, n, state.lines[n].point});
    }
    PatchDivision(&groups).Divide(
        landmarks.data(), landmarks.data() + landmarks.size(), kHalvings);
  }
  return groups;
}

template <class Track>
void Abandon(const std::vector<int>& groups, int group,
             std::vector<Track>* tracks) {
  for (std::size_t n = 0; n < tracks->size(); ++n) {
    if (groups[n] == group) {
      (*tracks)[n].Abandon(LandmarkStatus::kTooFewViews);
    }
  }
}

void Untie(const std::vector<int>& groups, int group,
           std::vector<PlaneTie>* ties) {
  const auto is_gone = [&](const PlaneTie& tie) {
    return groups[tie.landmark] == group;
  };
  ties->erase(std::remove_if(ties->begin(), ties->end(), is_gone), ties->end());
}

StructureState Without(StructureState state, const Groups& groups, int group) {
  Abandon(groups.of_points, group, &state.points);
  Abandon(groups.of_lines, group, &state.lines);
  for (PlaneState& plane : state.planes) {
    Untie(groups.of_points, group, &plane.points);
    Untie(groups.of_lines, group, &plane.lines);
  }
  for (PairState& pair : state.pairs) {
    pair.used = pair.used && state.HasLines(pair);
  }
  return state;
}

}  // namespace

Status AddJackknife(const AdjustmentOptions& options, const NoiseLevels& noise,
                    const RunContext& context, const CameraSet& cameras,
                    StructureState state, CenterUncertainty* uncertainty) {
  if (uncertainty->covariances.empty() || !MostAreSeenTwice(state)) return {};
  state.priors.clear();
  state.ratio_priors.clear();
  const std::vector<Component> components =
      FindComponents(cameras, state, SelectForSolve(cameras, state, options));
  const Groups groups = MakeGroups(components, cameras, state);
  std::mutex mutex;
  const RunContext own = ContextOfItem(context, kNumGroups, &mutex);
  std::vector<std::optional<CenterShift>> shifts(kNumGroups);
  std::vector<Status> statuses(kNumGroups);
  LOWLAP_RETURN_IF_ERROR(
      ParallelFor(context, {}, kNumGroups, [&](std::size_t group) {
        CameraSet moved = cameras;
        StructureState rest = Without(state, groups, static_cast<int>(group));
        const auto solved =
            SolveOnce(options, {"jackknife", false, kWeakModeTolerance, noise},
                      own, &moved, &rest);
        if (solved) {
          shifts[group].emplace(cameras, components, moved);
        } else if (solved.error().code == ErrorCode::kCancelled) {
          statuses[group] = tl::unexpected<Error>(solved.error());
        }
      }));
  for (const Status& status : statuses) LOWLAP_RETURN_IF_ERROR(status);
  const auto count = static_cast<double>(
      std::count_if(shifts.begin(), shifts.end(),
                    [](const auto& shift) { return shift.has_value(); }));
  for (const auto& shift : shifts) {
    if (shift) shift->AddDrawn((count - 1) / count, uncertainty);
  }
  return {};
}

}  // namespace lowlap
