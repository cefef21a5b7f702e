#pragma once

#include <map>
#include <optional>
#include <vector>

#include "lowlap/averaging/reliability/internal/bare_regions.h"
#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/geometry/types.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// What two solved cameras have in common, by where the points lie that either
/// observes.
struct ExpectedOverlap {
  /// Of the points of the view that should share less, those that the other
  /// should see as well.
  double share = 0;
  /// Of those, the points that the other does observe; of the two views, the
  /// larger share.
  double found = 0;
};

/// Predicts what views of a solved scene should see of one another's landmarks.
///
/// A view should see a landmark of another one that lies in its image, from a
/// direction that differs by 30 degrees at most and a distance by a factor of
/// two, so that features are found again, where it observes landmarks of its
/// own as far away, to a factor of two: else a bare wall may stand before it.
/// That is the median of the five nearest to that cell of the image, of 16
/// times 16, if they are within two cells of it. Of a view 512 landmarks are
/// looked at, evenly spaced in their order; a view with fewer than twenty says
/// nothing.
class OverlapPredictor {
 public:
  /// `scene` must outlive this.
  explicit OverlapPredictor(const Scene& scene);

  /// nullopt: a view has no pose, no intrinsic or too few landmarks.
  std::optional<ExpectedOverlap> Between(ViewId a, ViewId b) const;

  /// In the images of both, the points of the other that it should show
  /// (DivideOverlap, which takes `min_rate`), if they lie where it sees a
  /// surface to a fifth of its distance: what lies behind a corner would leave
  /// regions bare. None where Between is nullopt.
  OverlapRegions RegionsOf(ViewId a, ViewId b, double min_rate) const;

 private:
  struct SeenPoint {
    Vec3 position;  // in world
    double depth;   // distance from the centre
    const Landmark* landmark;
  };
  struct Camera {
    const Pose* pose;
    const Intrinsic* intrinsic;
    std::vector<SeenPoint> points;
    std::vector<double> depths;  // of the cells, by rows; NaN: not known

    // What is seen there is as far away, to that factor.
    bool SeesAt(const Vec2& pixel_px, double depth, double factor) const;
  };
  // A point of one camera that another one should see.
  struct Expected {
    ExpectedSighting seen;
    bool is_on_surface;
  };

  static std::vector<Expected> ExpectedPoints(const Camera& from,
                                              const Camera& to, ViewId to_view);
  static ExpectedOverlap Count(const Camera& from, const Camera& to,
                               ViewId to_view);

  std::map<ViewId, Camera> cameras_;
};

using ExpectedOverlaps = std::map<ViewPair, ExpectedOverlap>;

/// Of the pairs with a relative pose, and of those compared in vain, if
/// OverlapPredictor says something of them; none without structure. Cost: the
/// pairs times 1,024 points. The same for any number of threads. Error:
/// kCancelled.
Result<ExpectedOverlaps> PredictOverlaps(const Scene& scene,
                                         const RunContext& context);

}  // namespace lowlap
