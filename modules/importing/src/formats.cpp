/** The one list of formats: a new one adds a line here. */
#include "ImportFormat.h"
#include "bag/BagSource.h"
#include "folder/FolderSource.h"
#include "kitti/KittiSource.h"
#include "pcap/PcapSource.h"

namespace taut
{
const std::vector<ImportFormat>& importFormats()
{
    static const std::vector<ImportFormat> formats{
        {"ROS bag (.bag, .mcap, .db3)", isBag, openBag},
        {"packet capture (pcap, pcapng)", isPcap, openPcap},
        {"drive of KITTI raw", isKittiRaw, openKittiRaw},
        {"drive of KITTI-360", isKitti360, openKitti360},
        {"sequence of KITTI odometry", isKittiOdometry, openKittiOdometry},
        {"folder of clouds (CSV, PLY, PCD) and imu.csv", isPlainFolder, openPlainFolder},
    };
    return formats;
}
}  // namespace taut
