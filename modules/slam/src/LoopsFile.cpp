#include "taut/slam/LoopsFile.h"

#include <Eigen/Geometry>
#include <fstream>

#include "taut/core/format.h"
#include "taut/core/writeError.h"

namespace taut
{
void writeLoops(const std::string& path, const std::vector<LoopClosure>& loops)
{
    std::ofstream file(path);
    file << "from,to,x,y,z,qx,qy,qz,qw,source,overlap,inliers,conflicts,cells,residual_m,"
            "disagreement_m,directions,chi2,gap_m,gap_rad,verdict,reason\n";
    for (const LoopClosure& l : loops)
    {
        const Eigen::Quaterniond q(l.T_from_to.R);
        const Vector3d& p = l.T_from_to.p;
        const LoopEvidence& e = l.evidence;
        file << l.from << ',' << l.to
             << format(
                    ",%.6f,%.6f,%.6f,%.9f,%.9f,%.9f,%.9f,", p.x(), p.y(), p.z(), q.x(), q.y(),
                    q.z(), q.w())
             << l.source
             << format(
                    ",%.3f,%.3f,%.4f,%d,%.4f,%.4f,%d,%.3f,%.4f,%.5f,", e.overlap, e.inliers,
                    e.conflicts, e.cells, e.residual, e.disagreement, e.directions, e.chi2, e.gap,
                    e.gap_angle)
             << nameOf(l.verdict) << ",\"" << l.reason << "\"\n";
    }
    flushOrThrow(file, path);
}
}  // namespace taut
