#include "lowlap/averaging/strategies/internal/component_closure.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

namespace lowlap {
namespace {

// The ratio of two scales is the same in all solutions up to this.
constexpr double kSameRatio = 0.1;

struct UnitComponent {
  const RigidComponent* component = nullptr;
  std::size_t index = 0;  // in the caller's list
  std::vector<Vec3> centers;
  Vec3 mean = Vec3::Zero();
  double size = 1;
};

UnitComponent Normalized(const RigidComponent& component, std::size_t index) {
  UnitComponent unit;
  unit.component = &component;
  unit.index = index;
  for (const Vec3& center : component.centers) unit.mean += center;
  unit.mean /= static_cast<double>(component.centers.size());
  double squares = 0;
  for (const Vec3& center : component.centers) {
    squares += (center - unit.mean).squaredNorm();
  }
  unit.size =
      std::sqrt(squares / static_cast<double>(component.centers.size()));
  for (const Vec3& center : component.centers) {
    unit.centers.emplace_back((center - unit.mean) / unit.size);
  }
  return unit;
}

// Only components that share two views with others can be held by them.
std::vector<std::size_t> HeldComponents(
    const std::vector<RigidComponent>& components) {
  std::map<std::size_t, int> uses;
  std::vector<char> held(components.size(), 1);
  for (const RigidComponent& component : components) {
    for (const std::size_t view : component.views) ++uses[view];
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t b = 0; b < components.size(); ++b) {
      if (!held[b]) continue;
      const auto shared =
          std::count_if(components[b].views.begin(), components[b].views.end(),
                        [&](std::size_t view) { return uses.at(view) > 1; });
      if (shared >= 2) continue;
      held[b] = 0;
      changed = true;
      for (const std::size_t view : components[b].views) --uses[view];
    }
  }
  std::vector<std::size_t> indices;
  for (std::size_t b = 0; b < components.size(); ++b) {
    if (held[b]) indices.push_back(b);
  }
  return indices;
}

// The components that shared views connect with the first.
std::vector<UnitComponent> ConnectedWithFirst(
    const std::vector<UnitComponent>& components) {
  std::vector<char> reached(components.size(), 0);
  std::map<std::size_t, char> views;
  const auto reach = [&](std::size_t b) {
    reached[b] = 1;
    for (const std::size_t view : components[b].component->views)
      views[view] = 1;
  };
  reach(0);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t b = 1; b < components.size(); ++b) {
      const std::vector<std::size_t>& mine = components[b].component->views;
      if (reached[b] ||
          std::none_of(mine.begin(), mine.end(), [&](std::size_t view) {
            return views.count(view) > 0;
          })) {
        continue;
      }
      reach(b);
      changed = true;
    }
  }
  std::vector<UnitComponent> connected;
  for (std::size_t b = 0; b < components.size(); ++b) {
    if (reached[b]) connected.push_back(components[b]);
  }
  return connected;
}

// Normal equations in the scales, then the translations but the first, then
// the positions of the shared views.
class Closure {
 public:
  explicit Closure(const std::vector<UnitComponent>& components)
      : components_(components), count_(static_cast<int>(components.size())) {
    std::map<std::size_t, int> uses;
    for (const UnitComponent& component : components_) {
      for (const std::size_t view : component.component->views) ++uses[view];
    }
    int size = count_ + 3 * (count_ - 1);
    for (const auto& [view, count] : uses) {
      if (count < 2) continue;
      column_of_[view] = size;
      size += 3;
    }
    normal_ = Eigen::MatrixXd::Zero(size, size);
    for (int b = 0; b < count_; ++b) AddComponent(b);
    const int rest = size - count_;
    rest_.compute(normal_.bottomRightCorner(rest, rest));
    coupling_ = normal_.bottomLeftCorner(rest, count_);
  }

  Eigen::MatrixXd ScaleNormal() const {
    return normal_.topLeftCorner(count_, count_) -
           coupling_.transpose() * rest_.solve(coupling_);
  }
  bool IsSolved() const { return rest_.info() == Eigen::Success; }

  std::vector<Vec3> Translations(const Eigen::VectorXd& scales) const {
    const Eigen::VectorXd rest = rest_.solve(-coupling_ * scales);
    std::vector<Vec3> translations = {Vec3::Zero()};
    for (int b = 1; b < count_; ++b) {
      translations.emplace_back(rest.segment<3>(3 * (b - 1)));
    }
    return translations;
  }

 private:
  void AddComponent(int b) {
    const UnitComponent& component = components_[b];
    for (std::size_t n = 0; n < component.centers.size(); ++n) {
      const auto column = column_of_.find(component.component->views[n]);
      if (column == column_of_.end()) continue;
      // Residual: X - t - s x.
      const Vec3& x = component.centers[n];
      for (int axis = 0; axis < 3; ++axis) {
        std::vector<std::pair<int, double>> row = {{b, -x(axis)},
                                                   {column->second + axis, 1}};
        if (b > 0) row.emplace_back(count_ + 3 * (b - 1) + axis, -1);
        for (const auto& [i, value_i] : row) {
          for (const auto& [j, value_j] : row) {
            normal_(i, j) += value_i * value_j;
          }
        }
      }
    }
  }

  const std::vector<UnitComponent>& components_;
  const int count_;
  std::map<std::size_t, int> column_of_;  // of shared views
  Eigen::MatrixXd normal_;
  Eigen::MatrixXd coupling_;
  Eigen::LDLT<Eigen::MatrixXd> rest_;
};

// Per component, its scale over that of the first; nullopt where it is free.
std::vector<std::optional<double>> FixedRatios(
    const Eigen::MatrixXd& scale_normal, double stddev_rad) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale_normal);
  const double flat = std::pow(kSeparation * stddev_rad, 2);
  int num_flat = 1;  // the solution itself
  while (num_flat < scale_normal.rows() &&
         solver.eigenvalues()(num_flat) < flat) {
    ++num_flat;
  }
  const Eigen::MatrixXd basis = solver.eigenvectors().leftCols(num_flat);
  const Eigen::RowVectorXd first = basis.row(0);
  std::vector<std::optional<double>> ratios(
      static_cast<std::size_t>(scale_normal.rows()));
  if (!(first.squaredNorm() > 0)) return ratios;
  for (Eigen::Index b = 0; b < scale_normal.rows(); ++b) {
    const double ratio = basis.row(b).dot(first) / first.squaredNorm();
    const double spread = (basis.row(b) - ratio * first).norm();
    if (ratio > 0 && spread <= kSameRatio * ratio * first.norm()) {
      ratios[static_cast<std::size_t>(b)] = ratio;
    }
  }
  return ratios;
}

}  // namespace

std::vector<std::optional<ComponentPlacement>> CloseComponents(
    const std::vector<RigidComponent>& components) {
  std::vector<std::optional<ComponentPlacement>> placements(components.size());
  if (components.empty()) return placements;
  std::vector<UnitComponent> units;
  for (const std::size_t b : HeldComponents(components)) {
    units.push_back(Normalized(components[b], b));
    if (!(units.back().size > 0)) return placements;
  }
  if (units.size() < 2 || units.front().index != 0) return placements;
  units = ConnectedWithFirst(units);
  if (units.size() < 2) return placements;

  double stddev_rad = 0;
  for (const UnitComponent& unit : units) {
    stddev_rad = std::max(stddev_rad, unit.component->stddev_rad);
  }
  const Closure all(units);
  if (!all.IsSolved()) return placements;
  const std::vector<std::optional<double>> ratios =
      FixedRatios(all.ScaleNormal(), stddev_rad);

  std::vector<UnitComponent> fixed;
  std::vector<double> scales;
  for (std::size_t b = 0; b < units.size(); ++b) {
    if (!ratios[b]) continue;
    fixed.push_back(units[b]);
    scales.push_back(*ratios[b]);
  }
  if (fixed.size() < 2 || fixed.front().index != 0 ||
      ConnectedWithFirst(fixed).size() != fixed.size()) {
    return placements;
  }
  const Closure closure(fixed);
  if (!closure.IsSolved()) return placements;
  const std::vector<Vec3> translations =
      closure.Translations(Eigen::Map<const Eigen::VectorXd>(
          scales.data(), static_cast<int>(scales.size())));
  // Back from unit components, and into the frame of the first.
  const UnitComponent& frame = fixed.front();
  const double unit = frame.size / scales[0];
  for (std::size_t b = 0; b < fixed.size(); ++b) {
    ComponentPlacement placement;
    placement.scale = unit * scales[b] / fixed[b].size;
    placement.translation =
        unit * translations[b] + frame.mean - placement.scale * fixed[b].mean;
    placements[fixed[b].index] = placement;
  }
  return placements;
}

}  // namespace lowlap
