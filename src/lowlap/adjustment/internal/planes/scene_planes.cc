#include "lowlap/adjustment/internal/planes/scene_planes.h"

#include <algorithm>
#include <cmath>

#include "lowlap/adjustment/internal/planes/facet.h"
#include "lowlap/adjustment/internal/planes/plane_fit.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/union_find.h"

namespace lowlap {
namespace {

// What drift leaves of a plane. How much it is hardly matters, since ties are
// as loose as what they join is apart.
const double kMaxTurnRad = RadFromDeg(2.5);
constexpr double kMaxShift = 0.03;  // of the scene's reach
constexpr double kJoinReach = 3;    // deviations
constexpr std::size_t kMinTies = 4;

using FacetGroup = std::vector<const Facet*>;

// The connected part of the scene that each landmark is in: what nothing else
// joins, a plane does not.
std::vector<std::size_t> PartsOf(const std::vector<FreeLandmark>& landmarks) {
  int last = 0;
  for (const FreeLandmark& landmark : landmarks) {
    last = std::max(last, landmark.poses.back());
  }
  UnionFind joined(static_cast<std::size_t>(last) + 1);
  for (const FreeLandmark& landmark : landmarks) {
    for (const int pose : landmark.poses) {
      joined.Union(static_cast<std::size_t>(landmark.poses.front()),
                   static_cast<std::size_t>(pose));
    }
  }
  std::vector<std::size_t> parts;
  parts.reserve(landmarks.size());
  for (const FreeLandmark& landmark : landmarks) {
    parts.push_back(
        joined.Find(static_cast<std::size_t>(landmark.poses.front())));
  }
  return parts;
}

// How far two facets are from one plane, in what is allowed; below 1 they are
// taken for one.
double Difference(const Facet& a, const Facet& b, double reach) {
  const double cosine = std::abs(a.plane.normal.dot(b.plane.normal));
  const Vec3 between = a.center - b.center;
  const double shift = 0.5 * (std::abs(a.plane.normal.dot(between)) +
                              std::abs(b.plane.normal.dot(between)));
  return std::hypot(std::acos(std::min(1.0, cosine)) / kMaxTurnRad,
                    shift / (kMaxShift * reach));
}

std::size_t PartOf(const Facet& facet, const std::vector<std::size_t>& parts) {
  return parts[facet.members.front()];
}

// Each facet, the best first, goes to the group that has the one closest to
// it, or begins its own.
std::vector<FacetGroup> GroupFacets(const std::vector<Facet>& facets,
                                    const std::vector<std::size_t>& parts,
                                    const SceneReach& reach) {
  std::vector<FacetGroup> groups;
  for (const Facet& facet : facets) {
    const double across = reach.Along(facet.plane.normal);
    FacetGroup* closest = nullptr;
    double least = 1;
    for (FacetGroup& group : groups) {
      if (PartOf(*group.front(), parts) != PartOf(facet, parts)) continue;
      for (const Facet* other : group) {
        const double difference = Difference(facet, *other, across);
        if (difference < least) {
          least = difference;
          closest = &group;
        }
      }
    }
    if (closest == nullptr) {
      groups.emplace_back();
      closest = &groups.back();
    }
    closest->push_back(&facet);
  }
  return groups;
}

// How far the facet's plane is from the plane where its members are: the root
// of the mean square.
double DistanceBetween(const std::vector<FreeLandmark>& landmarks,
                       const Facet& facet, const Plane& plane) {
  double sum = 0;
  for (const int member : facet.members) {
    const Vec3 center = landmarks[member].Center();
    const double of_plane = plane.normal.dot(center) - plane.offset;
    const double of_facet = facet.plane.normal.dot(center) - facet.plane.offset;
    const double side = facet.plane.normal.dot(plane.normal) < 0 ? -1 : 1;
    sum += (of_plane - side * of_facet) * (of_plane - side * of_facet);
  }
  return std::sqrt(sum / static_cast<double>(facet.members.size()));
}

class PlaneBuilder {
 public:
  PlaneBuilder(const std::vector<FreeLandmark>& landmarks,
               const std::vector<std::size_t>& parts)
      : landmarks_(landmarks), parts_(parts), taken_(landmarks.size(), 0) {}

  // The plane of the facets, and takes what is on it; false if too little is.
  bool Build(const FacetGroup& facets, PlaneState* state) {
    std::vector<const FreeLandmark*> members;
    double thickest = 0;
    for (const Facet* facet : facets) {
      for (const int member : facet->members) {
        members.push_back(&landmarks_[member]);
      }
      thickest = std::max(thickest, facet->thickness);
    }
    // All members alike: the facets are off by more than the members' own
    // deviations.
    const Plane& best = facets.front()->plane;
    double spread = thickest;
    for (const Facet* facet : facets) {
      spread = std::max(spread, DistanceBetween(landmarks_, *facet, best));
    }
    const Plane plane = FitPlane(members, best, spread);
    state->normal = plane.normal;
    state->thickness = thickest;
    state->log10_nfa = facets.front()->log10_nfa;
    std::vector<PlaneMember> tied;
    std::vector<int> indices;
    const auto add = [&](int index, double looseness) {
      if (taken_[index] != 0) return;
      taken_[index] = 1;
      const FreeLandmark& landmark = landmarks_[index];
      (landmark.is_line ? state->lines : state->points)
          .push_back({landmark.index, looseness});
      state->anchor += landmark.Center();
      tied.push_back({&landmark, looseness * thickest});
      indices.push_back(index);
    };
    for (const Facet* facet : facets) {
      const double off = std::hypot(facet->thickness,
                                    DistanceBetween(landmarks_, *facet, plane));
      for (const int member : facet->members) add(member, off / thickest);
    }
    if (tied.size() < kMinTies) {
      for (const int index : indices) taken_[index] = 0;
      return false;
    }
    const std::size_t part = PartOf(*facets.front(), parts_);
    for (std::size_t n = 0; n < landmarks_.size(); ++n) {
      if (parts_[n] != part) continue;
      const Across across = AcrossPlane(landmarks_[n], plane);
      if (across.stddev <= thickest &&
          std::abs(across.distance) <=
              kJoinReach * std::hypot(across.stddev, thickest)) {
        add(static_cast<int>(n), 1);
      }
    }
    state->anchor /= static_cast<double>(tied.size());
    state->offset = plane.offset - plane.normal.dot(state->anchor);
    state->bend = FitBend(tied, plane, state->anchor, thickest);
    return true;
  }

 private:
  const std::vector<FreeLandmark>& landmarks_;
  const std::vector<std::size_t>& parts_;
  std::vector<char> taken_;
};

}  // namespace

Result<std::vector<PlaneState>> FindPlanes(
    const std::vector<FreeLandmark>& landmarks, const RunContext& context) {
  if (landmarks.empty()) return std::vector<PlaneState>();
  const SceneReach reach(landmarks);
  LOWLAP_ASSIGN_OR_RETURN(const std::vector<Facet> facets,
                          FindFacets(landmarks, reach, context));
  const std::vector<std::size_t> parts = PartsOf(landmarks);
  PlaneBuilder builder(landmarks, parts);
  std::vector<PlaneState> planes;
  for (const FacetGroup& group : GroupFacets(facets, parts, reach)) {
    PlaneState plane;
    if (builder.Build(group, &plane)) planes.push_back(std::move(plane));
  }
  return planes;
}

}  // namespace lowlap
