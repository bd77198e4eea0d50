#pragma once

#include <ctime>
#include <fstream>
#include <string>

#include "taut/core/Scan.h"
#include "taut/core/TimeText.h"

namespace taut::test
{
/** "2011-09-26 13:02:25.951199337" */
inline std::string dateText(Time t)
{
    const std::time_t seconds = t / 1'000'000'000;
    std::tm date{};
    gmtime_r(&seconds, &date);
    char text[40];
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &date);
    return text + formatSeconds(t % 1'000'000'000).substr(1);
}

inline std::string frameName(std::size_t frame, const std::string& ending)
{
    const std::string number = std::to_string(frame);
    return std::string(10 - number.size(), '0') + number + ending;
}

/** The points as KITTI has them: without times. */
inline void writeBin(const std::string& path, const Scan& scan)
{
    std::ofstream file(path, std::ios::binary);
    for (const LidarPoint& p : scan.points)
    {
        const float values[] = {p.position.x(), p.position.y(), p.position.z(), p.intensity / 255};
        file.write(reinterpret_cast<const char*>(values), sizeof values);
    }
}
}  // namespace taut::test
