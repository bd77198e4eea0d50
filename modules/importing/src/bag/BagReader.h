#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "WireReader.h"
#include "taut/core/Time.h"
#include "taut/core/Warning.h"

namespace taut::bag
{
struct BagTopic
{
    std::string name;
    std::string type;  //!< "package/Type", as ROS 1 writes it; empty if it is no ROS message
    Wire wire = Wire::Cdr;
    bool empty = false;  //!< known to have no message
};

struct BagMessage
{
    std::string topic;
    Wire wire = Wire::Cdr;
    Time received = 0;  //!< clock of the recorder
    Bytes data;         //!< valid until the next message is read
};

/** Messages of a bag in the order of the file, whatever its container. */
class BagReader
{
 public:
    virtual ~BagReader() = default;

    /** Of the whole bag; by its index if it has one, else by reading through it. */
    virtual std::vector<BagTopic> topics() = 0;

    /** Gives messages of these topics only. To be called once, before next(). */
    virtual void choose(const std::vector<std::string>& topics) = 0;

    /** The next message; nothing at the end, or where the file is too damaged to go on. Damage is
     * reported to the sink that the reader was given. */
    virtual std::optional<BagMessage> next() = 0;

    virtual double progress() const = 0;  //!< 0 to 1
};

/** "package/msg/Type" as "package/Type". */
std::string plainType(std::string type);

/** All throw std::runtime_error naming the file if it is missing or of another format. */
std::unique_ptr<BagReader> openRos1Bag(const std::string& path, const WarningSink& warn);
std::unique_ptr<BagReader> openMcap(const std::string& path, const WarningSink& warn);
std::unique_ptr<BagReader> openSqlite3Bag(const std::string& path, const WarningSink& warn);
std::unique_ptr<BagReader> openBagFolder(const std::string& path, const WarningSink& warn);

/** One of the above, by the content. */
std::unique_ptr<BagReader> openBagReader(const std::string& path, const WarningSink& warn);
}  // namespace taut::bag
