#include "lowlap/merge/internal/rigid_pieces.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "lowlap/averaging/internal/sparse_solver.h"
#include "lowlap/averaging/rigidity/internal/diagnosis.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/merge/internal/linked_pieces.h"
#include "lowlap/merge/internal/signed_clusters.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

// The log ratio of two baselines at a camera, as a linear function of the
// movements of three centres.
struct LogRatioGradient {
  std::array<Eigen::Index, 3> rows;  // of first, middle, last
  std::array<Vec3, 3> slopes;
};

// Directions and ratios that agree, with their deviations.
struct Agreeing {
  ViewGraph graph;
  std::vector<double> direction_stddevs_rad;  // by pair of the graph
  std::map<ViewTriplet, double> ratio_stddevs;
};

Agreeing FindAgreeing(const std::vector<PairAgreement>& pairs,
                      const std::vector<RatioAgreement>& ratios, double reach) {
  std::vector<ViewPair> views;
  for (const PairAgreement& pair : pairs) {
    if (pair.Agrees()) views.push_back(pair.views);
  }
  Agreeing agreeing;
  agreeing.graph = ViewGraph(std::move(views));
  agreeing.direction_stddevs_rad.resize(agreeing.graph.pairs().size());
  for (const PairAgreement& pair : pairs) {
    if (!pair.Agrees()) continue;
    const auto index =
        agreeing.graph.FindPair(pair.views.first, pair.views.second);
    agreeing.direction_stddevs_rad[*index] = pair.direction_limit_rad / reach;
  }
  for (const RatioAgreement& ratio : ratios) {
    if (ratio.Agrees() &&
        agreeing.graph.FindPair(ratio.views.first, ratio.views.middle) &&
        agreeing.graph.FindPair(ratio.views.middle, ratio.views.last)) {
      agreeing.ratio_stddevs.emplace(ratio.views, ratio.limit / reach);
    }
  }
  return agreeing;
}

// How well views are fixed by what agrees between them.
class Firmness {
 public:
  Firmness(const std::map<ViewId, Pose>& poses, const Agreeing& agreeing,
           const RunContext& context)
      : solver_(context) {
    const ViewGraph& graph = agreeing.graph;
    Vec3 mean = Vec3::Zero();
    double length = 0;
    for (const ViewPair& views : graph.pairs()) {
      length += (poses.at(views.first).center - poses.at(views.second).center)
                    .norm() /
                static_cast<double>(graph.pairs().size());
    }
    for (const ViewId view : graph.views()) {
      row_.emplace(view, static_cast<Eigen::Index>(3 * row_.size()));
      centers_.emplace(view, poses.at(view).center / length);
      mean += centers_.at(view) / static_cast<double>(graph.views().size());
    }
    double spread = 0;
    for (const auto& entry : centers_) {
      spread += (entry.second - mean).squaredNorm();
    }
    constexpr double kFreeFactor = 10;
    const double prior = 1 / (kFreeFactor * kFreeFactor * spread);
    for (Eigen::Index r = 0; r < NumRows(); ++r) {
      entries_.emplace_back(r, r, prior);
    }
    for (std::size_t e = 0; e < graph.pairs().size(); ++e) {
      AddDirection(graph.pairs()[e], agreeing.direction_stddevs_rad[e]);
    }
    for (const auto& [views, stddev] : agreeing.ratio_stddevs) {
      AddRatio(views, stddev);
    }
  }

  /// To be called once, before Deviations.
  Status Factorize() {
    Eigen::SparseMatrix<double> information(NumRows(), NumRows());
    information.setFromTriplets(entries_.begin(), entries_.end());
    return solver_.Factorize(information);
  }

  /// The standard deviations of log ratios.
  Result<std::vector<double>> Deviations(
      const std::vector<ViewTriplet>& triplets) {
    Eigen::MatrixXd gradients = Eigen::MatrixXd::Zero(
        NumRows(), static_cast<Eigen::Index>(triplets.size()));
    for (std::size_t t = 0; t < triplets.size(); ++t) {
      const LogRatioGradient g = GradientOf(triplets[t]);
      for (std::size_t n = 0; n < 3; ++n) {
        gradients.block<3, 1>(g.rows[n], static_cast<Eigen::Index>(t)) +=
            g.slopes[n];
      }
    }
    LOWLAP_ASSIGN_OR_RETURN(const auto solved, solver_.Solve(gradients));
    std::vector<double> deviations;
    for (Eigen::Index t = 0; t < gradients.cols(); ++t) {
      deviations.push_back(
          std::sqrt(std::max(0.0, gradients.col(t).dot(solved.col(t)))));
    }
    return deviations;
  }

 private:
  void AddDirection(const ViewPair& views, double stddev_rad) {
    const Vec3 baseline = centers_.at(views.second) - centers_.at(views.first);
    const double length = baseline.norm();
    const Vec3 unit = baseline / length;
    const Mat3 block = (Mat3::Identity() - unit * unit.transpose()) /
                       std::pow(length * stddev_rad, 2);
    const Eigen::Index a = row_.at(views.first), b = row_.at(views.second);
    Add(a, a, block);
    Add(b, b, block);
    Add(a, b, -block);
    Add(b, a, -block);
  }

  void AddRatio(const ViewTriplet& views, double stddev) {
    const LogRatioGradient g = GradientOf(views);
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        Add(g.rows[a], g.rows[b],
            g.slopes[a] * g.slopes[b].transpose() / (stddev * stddev));
      }
    }
  }

  Eigen::Index NumRows() const {
    return static_cast<Eigen::Index>(3 * row_.size());
  }

  // The lower triangle.
  void Add(Eigen::Index a, Eigen::Index b, const Mat3& block) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        if (a + r >= b + c) entries_.emplace_back(a + r, b + c, block(r, c));
      }
    }
  }

  LogRatioGradient GradientOf(const ViewTriplet& views) const {
    const Vec3 from = centers_.at(views.middle) - centers_.at(views.first);
    const Vec3 to = centers_.at(views.last) - centers_.at(views.middle);
    const Vec3 of_from = from / from.squaredNorm();
    const Vec3 of_to = to / to.squaredNorm();
    return {{row_.at(views.first), row_.at(views.middle), row_.at(views.last)},
            {of_from, -of_from - of_to, of_to}};
  }

  std::map<ViewId, Eigen::Index> row_;
  std::map<ViewId, Vec3> centers_;  // the mean baseline is 1
  std::vector<Eigen::Triplet<double>> entries_;
  SparseSolver solver_;
};

// What agrees between a view and its neighbours; of the ratios, those of the
// triplets, all in the middle of which is the view.
Agreeing Nearby(const Agreeing& agreeing, ViewId middle,
                const std::vector<ViewTriplet>& triplets) {
  std::vector<ViewId> views = agreeing.graph.NeighborsOf(middle);
  views.push_back(middle);
  std::sort(views.begin(), views.end());
  std::vector<ViewPair> pairs;
  for (const ViewId view : views) {
    for (const ViewId other : agreeing.graph.NeighborsOf(view)) {
      if (view < other &&
          std::binary_search(views.begin(), views.end(), other)) {
        pairs.push_back({view, other});
      }
    }
  }
  Agreeing nearby;
  nearby.graph = ViewGraph(std::move(pairs));
  for (const ViewPair& pair : nearby.graph.pairs()) {
    nearby.direction_stddevs_rad.push_back(
        agreeing.direction_stddevs_rad[*agreeing.graph.FindPair(pair.first,
                                                                pair.second)]);
  }
  for (const ViewTriplet& asked : triplets) {
    const auto ratio = agreeing.ratio_stddevs.find(asked);
    if (ratio != agreeing.ratio_stddevs.end()) {
      nearby.ratio_stddevs.insert(*ratio);
    }
  }
  return nearby;
}

// What a measured ratio says for or against one scale of its two baselines: as
// much against it beyond its limit as for it where it agrees, and nothing
// between. Far from where a model was put together a wrong scale changes ratios
// by little.
double EvidenceOf(const RatioAgreement& ratio) {
  const double weight = 1 + std::log1p(std::max(0.0, -ratio.log10_nfa));
  const double relative = ratio.error / ratio.limit;
  return weight * std::max(-1.0, 1 - 2 * relative * relative);
}

// Those of the triplets, by their middle views, whose ratios are fixed to
// `firm`. What its neighbours fix about a view is fixed; only of the rest, few
// as a rule, all views are asked, at a cost that grows with their square.
Result<std::vector<ViewTriplet>> FirmTriplets(
    const std::map<ViewId, Pose>& poses, const Agreeing& agreeing,
    const std::map<ViewId, std::vector<ViewTriplet>>& asked, double firm,
    const RunContext& context) {
  const auto go_on = [&](std::size_t done, std::size_t total) -> Status {
    if (context.Progress("rigid pieces", done, total)) return {};
    return MakeError(ErrorCode::kCancelled, "stopped on request", {},
                     "rigid pieces");
  };
  std::vector<ViewTriplet> fixed, open;
  std::size_t num_done = 0;
  for (const auto& [middle, triplets] : asked) {
    LOWLAP_RETURN_IF_ERROR(go_on(num_done++, asked.size()));
    Firmness nearby(poses, Nearby(agreeing, middle, triplets), context);
    LOWLAP_RETURN_IF_ERROR(nearby.Factorize());
    LOWLAP_ASSIGN_OR_RETURN(const auto deviations, nearby.Deviations(triplets));
    for (std::size_t n = 0; n < triplets.size(); ++n) {
      (deviations[n] <= firm ? fixed : open).push_back(triplets[n]);
    }
  }
  if (open.empty()) return fixed;
  Firmness everywhere(poses, agreeing, context);
  LOWLAP_RETURN_IF_ERROR(everywhere.Factorize());
  constexpr std::size_t kAtOnce = 256;
  for (std::size_t next = 0; next < open.size(); next += kAtOnce) {
    LOWLAP_RETURN_IF_ERROR(go_on(next, open.size()));
    const std::vector<ViewTriplet> some(
        open.begin() + next,
        open.begin() + std::min(next + kAtOnce, open.size()));
    LOWLAP_ASSIGN_OR_RETURN(const auto deviations, everywhere.Deviations(some));
    for (std::size_t n = 0; n < some.size(); ++n) {
      if (deviations[n] <= firm) fixed.push_back(some[n]);
    }
  }
  return fixed;
}

}  // namespace

Result<std::vector<RigidPiece>> FindRigidPieces(
    const std::map<ViewId, Pose>& poses,
    const std::vector<PairAgreement>& pairs,
    const std::vector<RatioAgreement>& ratios, double reach,
    const RunContext& context) {
  const Agreeing agreeing = FindAgreeing(pairs, ratios, reach);
  const ViewGraph& graph = agreeing.graph;
  if (graph.pairs().empty()) return std::vector<RigidPiece>();

  std::map<ViewTriplet, const RatioAgreement*> measured;
  for (const RatioAgreement& ratio : ratios) {
    measured.emplace(ratio.views, &ratio);
  }
  const double firm = DiagnosisOptions().max_stddev;
  std::vector<SignedLink> links;
  std::map<ViewId, std::vector<ViewTriplet>> asked;  // by middle view
  const auto link = [&](const ViewTriplet& views, double evidence) {
    links.push_back({*graph.FindPair(views.first, views.middle),
                     *graph.FindPair(views.middle, views.last), evidence});
  };
  for (const ViewTriplet& views : FindTriplets(graph)) {
    const auto found = measured.find(views);
    if (found != measured.end() &&
        (!found->second->Agrees() || found->second->limit <= reach * firm)) {
      link(views, EvidenceOf(*found->second));
    } else {
      asked[views.middle].push_back(views);
    }
  }
  LOWLAP_ASSIGN_OR_RETURN(const auto fixed,
                          FirmTriplets(poses, agreeing, asked, firm, context));
  // What follows from directions about one baseline at one view is one
  // statement, with however many others it shares the view.
  std::map<std::pair<ViewId, ViewId>, int> num_fixed;  // middle, other end
  for (const ViewTriplet& views : fixed) {
    ++num_fixed[{views.middle, views.first}];
    ++num_fixed[{views.middle, views.last}];
  }
  for (const ViewTriplet& views : fixed) {
    const auto found = measured.find(views);
    link(views, found != measured.end()
                    ? EvidenceOf(*found->second)
                    : 1.0 / std::max(num_fixed.at({views.middle, views.first}),
                                     num_fixed.at({views.middle, views.last})));
  }
  return PiecesOfLinks(graph, std::move(links));
}

}  // namespace lowlap
