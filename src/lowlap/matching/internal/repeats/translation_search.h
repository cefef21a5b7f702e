#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/matching/internal/repeats/conjugate_translation.h"

namespace lowlap {

/// The search for translations within planes that alike places of one
/// photograph bear out, by random samples of them.
class TranslationSearch {
 public:
  explicit TranslationSearch(std::vector<AlikePlaces> places);

  /// The translation of least NFA. That k of n points have one of their alike
  /// places where the translation takes them, p the expected number of such
  /// places of a point with partners drawn at random, has
  ///   NFA = M^2 C(n, k) C(k, 2) p^(k - 2),
  /// M alike places, of which two give a translation. nullopt: none is below 1.
  std::optional<ConjugateTranslation> Best();

  /// The places that agree, one of each point, ascending.
  std::vector<AlikePlaces> Explained(
      const ConjugateTranslation& translation) const;

  /// Leaves out all places of the points of `explained` (ascending).
  void Remove(const std::vector<AlikePlaces>& explained);

 private:
  const AlikePlaces& Any();
  std::optional<ConjugateTranslation> Sample();
  std::optional<ConjugateTranslation> Refined(
      ConjugateTranslation translation, std::size_t most,
      std::initializer_list<double> tolerance_factors) const;
  double Excess(const ConjugateTranslation& translation,
                std::size_t most) const;
  double Log10Nfa(const ConjugateTranslation& translation);

  std::vector<AlikePlaces> places_;  // in random order
  std::vector<Vec3> lines_;          // vanishing lines of what was found
  Random random_{0};  // what repeats is a matter of the photograph alone
};

}  // namespace lowlap
