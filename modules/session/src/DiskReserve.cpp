#include "DiskReserve.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "taut/core/writeError.h"

namespace taut
{
namespace
{
constexpr const char* kName = ".taut-reserve";
constexpr off_t kBytes =
    1 << 20;  // metrics.json has some 10 kB, 200 kB where all warnings are long
}  // namespace

DiskReserve::DiskReserve(const std::filesystem::path& folder) : path_(folder / kName)
{
    if (isTaken(folder))
        throw std::runtime_error("another program writes to '" + folder.string() + "' now");
    file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) throw writeError(path_.string());
    ::flock(file_, LOCK_EX | LOCK_NB);
    const int error = ::posix_fallocate(file_, 0, kBytes);
    if (error == 0) return;
    release();
    ::close(file_);
    errno = error;
    throw writeError(folder.string());
}

DiskReserve::~DiskReserve()
{
    std::error_code ignored;  // it may be gone already
    std::filesystem::remove(path_, ignored);
    ::close(file_);
}

void DiskReserve::release()
{
    [[maybe_unused]] const int kept_if_not = ::ftruncate(file_, 0);
}

bool DiskReserve::isTaken(const std::filesystem::path& folder)
{
    const int file = ::open((folder / kName).c_str(), O_WRONLY | O_CLOEXEC);
    if (file < 0) return false;
    const bool taken = ::flock(file, LOCK_EX | LOCK_NB) != 0;
    ::close(file);
    return taken;
}
}  // namespace taut
