#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "GzInput.h"
#include "ObjectHeader.h"

namespace taut
{
/** The bytes of one LiDAR or IMU observation, taken out of a rawlog. MRPT believes the sizes that
 * are written in a file and allocates before it reads. Here the same fields are followed without
 * that: memory grows with the bytes that are there, and what is complete can be given to MRPT. */
class ObjectCopy
{
 public:
    /** True for the classes whose fields are known here. */
    static bool knows(const std::string& short_name);

    /** Reads the object that begins at the stream's position. Throws std::runtime_error if the
     * stream ends in it, if a size in it exceeds what a scan can hold, and for a version of a class
     * that is not known. */
    ObjectCopy(GzInput& input, const ObjectHeader& header);

    /** Header, fields and end mark, as in the file but for booleans, which are 0 or 1. */
    const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
    const std::uint8_t* take(std::uint64_t count);
    template <class T>
    T number();
    std::uint64_t values(std::size_t bytes_each, std::uint64_t most);
    void flags(std::size_t count);
    void string();
    void end();
    void pose();
    void imu(int version);
    void velodyne(int version);
    void rotating(int version);
    std::uint64_t image(std::size_t bytes_each);

    GzInput& input_;
    std::vector<std::uint8_t> bytes_;
};
}  // namespace taut
