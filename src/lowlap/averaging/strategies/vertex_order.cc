#include "lowlap/averaging/strategies/internal/vertex_order.h"

#include <queue>

namespace lowlap {
namespace {

struct VertexState {
  std::vector<std::size_t> in, out;  // arcs
  std::size_t num_in = 0;            // arcs from vertices not yet laid down
  double weight_in = 0, weight_out = 0;
  bool is_placed = false;

  bool IsSource() const { return num_in == 0; }
  double Score() const { return (weight_out + 1) / (weight_in + 1); }
};

// What the queue knew of a vertex when it was entered.
struct Candidate {
  bool is_source;
  double score;
  std::size_t vertex;

  // Less urgent first, as std::priority_queue wants it.
  friend bool operator<(const Candidate& a, const Candidate& b) {
    if (a.is_source != b.is_source) return b.is_source;
    if (!a.is_source && a.score != b.score) return a.score < b.score;
    return a.vertex > b.vertex;
  }
};

}  // namespace

std::vector<std::size_t> OrderVertices(std::size_t num_vertices,
                                       const std::vector<WeightedArc>& arcs) {
  std::vector<VertexState> vertices(num_vertices);
  for (std::size_t a = 0; a < arcs.size(); ++a) {
    VertexState& from = vertices[arcs[a].from];
    VertexState& to = vertices[arcs[a].to];
    from.out.push_back(a);
    from.weight_out += arcs[a].weight;
    to.in.push_back(a);
    to.weight_in += arcs[a].weight;
    ++to.num_in;
  }
  std::priority_queue<Candidate> queue;
  const auto enter = [&](std::size_t v) {
    queue.push({vertices[v].IsSource(), vertices[v].Score(), v});
  };
  for (std::size_t v = 0; v < num_vertices; ++v) enter(v);

  std::vector<std::size_t> place(num_vertices, 0);
  std::size_t next_place = 0;
  while (!queue.empty()) {
    const Candidate best = queue.top();
    queue.pop();
    VertexState& vertex = vertices[best.vertex];
    // An entry that a later one has replaced.
    if (vertex.is_placed || best.is_source != vertex.IsSource() ||
        (!best.is_source && best.score != vertex.Score())) {
      continue;
    }
    vertex.is_placed = true;
    place[best.vertex] = next_place++;
    for (const std::size_t a : vertex.out) {
      VertexState& other = vertices[arcs[a].to];
      if (other.is_placed) continue;
      other.weight_in -= arcs[a].weight;
      --other.num_in;
      enter(arcs[a].to);
    }
    for (const std::size_t a : vertex.in) {
      VertexState& other = vertices[arcs[a].from];
      if (other.is_placed) continue;
      other.weight_out -= arcs[a].weight;
      enter(arcs[a].from);
    }
  }
  return place;
}

}  // namespace lowlap
