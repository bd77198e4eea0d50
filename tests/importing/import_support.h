#pragma once

#include <string>
#include <vector>

#include "taut/core/WarningLog.h"
#include "taut/importing/openImportSource.h"

namespace taut::test
{
constexpr Time kStart = 1'700'000'000'000'000'000;
constexpr Duration kMillisecond = 1'000'000;

/** Everything that a source gives. */
struct Imported
{
    ImuSamples imu;
    std::vector<Scan> scans;
    std::vector<PacketScan> packet_scans;
    std::vector<std::string> findings;
    WarningLog warnings;
    std::string failure;  //!< of opening or reading; empty if there was none
};

inline Imported importAll(const std::string& path, const ImportOptions& options = {})
{
    Imported all;
    try
    {
        const auto source = openImportSource(path, options, all.warnings.sink());
        while (auto item = source->next())
        {
            if (const auto* sample = std::get_if<ImuSample>(&*item)) all.imu.push_back(*sample);
            if (auto* scan = std::get_if<Scan>(&*item)) all.scans.push_back(std::move(*scan));
            if (auto* scan = std::get_if<PacketScan>(&*item))
                all.packet_scans.push_back(std::move(*scan));
        }
        all.findings = source->findings();
    }
    catch (const std::runtime_error& e)
    {
        all.failure = e.what();
    }
    return all;
}
}  // namespace taut::test
