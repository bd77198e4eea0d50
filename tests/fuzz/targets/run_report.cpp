#include "support.h"
#include "taut/report/writeReport.h"
#include "taut/session/RunReport.h"

/* The results of a run, as its page is made of them: a piece for each file. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    static const fuzz::Folder folder;
    folder.writePieces(
        input, {"trajectory.tum", "metrics.json", "states.csv", "timing.csv", "loops.csv",
                "map.ply", "graph.g2o", "config.yaml", "submaps/00000.tsm"});
    fuzz::readOrRefuse(
        [&]
        {
            const Report report = readRunReport(folder.path(), {}, [](const Warning&) {});
            writeReport(report, folder / "report.html", 3'000'000);
        });
}
