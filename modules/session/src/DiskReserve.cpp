#include "DiskReserve.h"

#include <fcntl.h>
#include <unistd.h>

#include "taut/core/writeError.h"

namespace taut
{
namespace
{
constexpr off_t kBytes =
    1 << 20;  // metrics.json has some 10 kB, 200 kB where all warnings are long
}

DiskReserve::DiskReserve(const std::filesystem::path& folder) : file_(folder / ".taut-reserve")
{
    const int file = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) throw writeError(file_.string());
    const int error = ::posix_fallocate(file, 0, kBytes);
    ::close(file);
    if (error == 0) return;
    release();
    errno = error;
    throw writeError(folder.string());
}

void DiskReserve::release()
{
    std::error_code ignored;  // it is gone already
    std::filesystem::remove(file_, ignored);
}
}  // namespace taut
