#pragma once

#include <string>

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

struct TripletProgramOptions {
  /// A triangle of edges whose directions (with its ratio, if it has one) miss
  /// closing by more than this is no triplet.
  double max_closure_deg = 5.0;
  /// Without a ratio, lengths come from the directions alone; a triangle with
  /// a smaller angle than this is then too flat.
  double min_angle_deg = 3.0;
  /// An edge that this many better triplets hold already asks for no more.
  int max_triplets_per_edge = 3;

  Status Validate() const;
  template <class Visit>
  void VisitOptions(const Visit& visit) {
    visit("max_closure_deg", &max_closure_deg,
          "triangles that miss closing by more do not count");
    visit("min_angle_deg", &min_angle_deg,
          "triangles without a ratio and with a smaller angle do not count");
    visit("max_triplets_per_edge", &max_triplets_per_edge,
          "an edge that so many better triplets hold asks for no more");
  }
};

/// Centres from the motions of view triplets by one linear program (Moulon,
/// Monasse, Marlet, "Global fusion of relative motions for robust, accurate and
/// scalable structure from motion", ICCV 2013, section 4).
///
/// A triplet tau is a triangle of edges {ab, bc, ac} whose three baselines
/// v_tau are known up to one scale: from its most meaningful ratio, where it
/// has one (v_ac is then v_ab + v_bc), else from the three directions,
///   min |x d_ab + y d_bc - z d_ac|,  |(x, y, z)| = 1.
/// Triplets with a common edge share a scale. For each such set of triplets,
/// with the unknown centres C and triplet scales lambda,
///   min gamma  s.t.  |C_j - C_i - lambda_tau v_tau_ij|_inf <= gamma,
///                    lambda_tau >= 1,  C of one view = 0,             (linf)
/// or the sum of all absolute values instead of their maximum         (l1_lp).
///
/// Views outside every triplet are not placed: a chain has no triangle. Not
/// robust: l1_lp bears a few wrong triplets, while linf is decided by the worst
/// one, and so is its error; the paper relies on triplets that were verified
/// one by one beforehand (by the tracks of three views). Nor does the residual,
/// a distance, tell uncertain edges from certain ones. The maximum is that over
/// the world's axes, as in the paper; it depends on the world frame.
///
/// Solved by the simplex method, whose time grows fast: kUnsupported beyond
/// 6000 triplets that hang together (linf) or 2000 (l1_lp), the triplets of
/// about 1100 or 400 views with four edges each.
class TripletProgramAverager : public TranslationAverager {
 public:
  enum class Norm { kMaximum, kSum };

  explicit TripletProgramAverager(Norm norm, TripletProgramOptions options = {})
      : norm_(norm), options_(options) {}
  std::string Name() const override {
    return norm_ == Norm::kMaximum ? "linf" : "l1_lp";
  }
  std::string Needs() const override {
    return "a triangle of relative poses that shares an edge with the "
           "others' triangles";
  }
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext& context) const override;

 private:
  Norm norm_;
  TripletProgramOptions options_;
};

}  // namespace lowlap
