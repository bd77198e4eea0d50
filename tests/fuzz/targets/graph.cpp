#include "support.h"
#include "taut/graph/G2oFile.h"

/* graph.g2o; what is written of it reads back to the same. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    static const fuzz::Folder folder;
    const std::string path = folder.write("graph.g2o", input);
    fuzz::readOrRefuse(
        [&]
        {
            const PoseGraph graph = readG2o(path);
            writeG2o(folder / "again.g2o", graph);
            const PoseGraph again = readG2o(folder / "again.g2o");
            fuzz::require(
                again.vertices.size() == graph.vertices.size() &&
                    again.relative_edges.size() == graph.relative_edges.size() &&
                    again.gravity_edges.size() == graph.gravity_edges.size(),
                "a graph that is written reads back");
        });
}
