/** The one list of formats: a new one adds a line here. */
#include "ImportFormat.h"
#include "bag/BagSource.h"
#include "pcap/PcapSource.h"

namespace taut
{
const std::vector<ImportFormat>& importFormats()
{
    static const std::vector<ImportFormat> formats{
        {"ROS bag (.bag, .mcap, .db3)", isBag, openBag},
        {"packet capture (pcap, pcapng)", isPcap, openPcap},
    };
    return formats;
}
}  // namespace taut
