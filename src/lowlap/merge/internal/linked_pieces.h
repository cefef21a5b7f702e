#pragma once

#include <vector>

#include "lowlap/merge/internal/signed_clusters.h"
#include "lowlap/merge/merge_models.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {

/// The rigid pieces of three views at least, most views first, that links
/// between the baselines of a graph hold together (ClusterByLinks).
///
/// Two pieces of one model that share two views have one scale, that of the
/// distance between these. So they are one, unless the links between them say
/// that they are not: then one view at most is in both, that in which more
/// baselines of either side meet than in any other (two at least). Of every
/// other view the side that has fewer there loses these: baselines that span
/// the gap between others, too straight to tell how wide it is, bear each other
/// out and nothing else. What is left is clustered again.
std::vector<RigidPiece> PiecesOfLinks(const ViewGraph& graph,
                                      std::vector<SignedLink> links);

}  // namespace lowlap
