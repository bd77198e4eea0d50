#include "taut/core/PoseGraph.h"

#include <algorithm>

namespace taut
{
std::ptrdiff_t PoseGraph::indexOf(VertexId id) const
{
    const auto found = std::find_if(
        vertices.begin(), vertices.end(), [id](const GraphVertex& v) { return v.id == id; });
    return found == vertices.end() ? -1 : found - vertices.begin();
}
}  // namespace taut
