#include "taut/rawlog/RawlogRecorder.h"

#include <fcntl.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/serialization/archiveFrom_std_vector.h>
#include <sys/file.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

namespace taut
{
namespace
{
constexpr auto kPatience = std::chrono::milliseconds(100);
constexpr unsigned kBuffer = 1u << 18;

std::string causeOf(int error)
{
    return error != 0 ? std::strerror(error) : "an earlier error";
}
}  // namespace

struct RawlogRecorder::Impl
{
    Impl(std::string p, int gz_level) : path(std::move(p))
    {
        const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file < 0 && errno == EEXIST)
            throw std::runtime_error(
                "'" + path + "' is there already: a recording is not written over");
        if (file < 0) fail(errno);
        ::flock(file, LOCK_EX | LOCK_NB);  // for others to see; nobody else has it yet
        const std::string mode =
            gz_level == 0 ? "wbT" : "wb" + std::to_string(std::clamp(gz_level, 1, 9));
        output = gzdopen(file, mode.c_str());
        if (output == nullptr)
        {
            ::close(file);
            fail(ENOMEM);
        }
        gzbuffer(output, kBuffer);
    }

    [[noreturn]] void fail(int error) const
    {
        throw std::runtime_error("cannot write '" + path + "': " + causeOf(error));
    }

    void write(const std::vector<std::uint8_t>& object);
    void close();
    LogGrowth waitForGrowth();

    const std::string path;
    mutable std::mutex mutex;  // of all that follows
    std::condition_variable changed;
    gzFile output = nullptr;  // null: closed
    std::size_t observations = 0, told = 0;
    std::uint64_t bytes = 0;
};

void RawlogRecorder::Impl::write(const std::vector<std::uint8_t>& object)
{
    const std::lock_guard lock(mutex);
    if (output == nullptr) throw std::logic_error("'" + path + "' was closed already");
    errno = 0;
    if (gzwrite(output, object.data(), static_cast<unsigned>(object.size())) <= 0 ||
        gzflush(output, Z_SYNC_FLUSH) != Z_OK)
        fail(errno);
    observations++;
    bytes += object.size();
    changed.notify_one();
}

void RawlogRecorder::Impl::close()
{
    const std::lock_guard lock(mutex);
    if (output == nullptr) return;
    errno = 0;
    const int code = gzclose_w(std::exchange(output, nullptr));
    changed.notify_one();
    if (code != Z_OK) fail(errno);
}

LogGrowth RawlogRecorder::Impl::waitForGrowth()
{
    std::unique_lock lock(mutex);
    changed.wait_for(lock, kPatience, [this] { return told != observations || output == nullptr; });
    told = observations;
    return output == nullptr ? LogGrowth::Complete : LogGrowth::More;
}

RawlogRecorder::RawlogRecorder(const std::string& path, int gz_level)
    : impl_(std::make_unique<Impl>(path, gz_level))
{
}

RawlogRecorder::~RawlogRecorder()
{
    try
    {
        close();
    }
    catch (const std::exception&)  // as told
    {
    }
}

void RawlogRecorder::write(const mrpt::obs::CObservation& observation)
{
    std::vector<std::uint8_t> object;
    auto archive = mrpt::serialization::archiveFrom(object);
    archive << observation;
    impl_->write(object);
}

void RawlogRecorder::close()
{
    impl_->close();
}

std::size_t RawlogRecorder::observations() const
{
    const std::lock_guard lock(impl_->mutex);
    return impl_->observations;
}

std::uint64_t RawlogRecorder::bytes() const
{
    const std::lock_guard lock(impl_->mutex);
    return impl_->bytes;
}

LogGrowth RawlogRecorder::waitForGrowth()
{
    return impl_->waitForGrowth();
}
}  // namespace taut
