#pragma once

#include <mrpt/rtti/CObject.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "taut/core/Config.h"

namespace taut
{
/** Creates the class of that name, registered with MRPT's class factory, as the plug point
 * `Interface`. Throws ConfigError if no such class is registered or if it is not one of that plug
 * point. */
template <class Interface>
std::shared_ptr<Interface> createPlugin(const std::string& class_name)
{
    const mrpt::rtti::CObject::Ptr object = mrpt::rtti::classFactory(class_name);
    if (!object)
        throw ConfigError(
            "no class named '" + class_name + "' is registered (is its plug-in loaded with -p?)");
    auto plugin = std::dynamic_pointer_cast<Interface>(object);
    if (!plugin)
        throw ConfigError(
            "class '" + class_name + "' is not a " +
            Interface::GetRuntimeClassIdStatic().className);
    return plugin;
}

/** Reads key `type` of the section, creates that class and lets it read the rest. */
template <class Interface>
std::shared_ptr<Interface> createConfigured(ConfigSection& section, std::string default_class)
{
    section.key("type", default_class, "class of this plug point");
    auto plugin = createPlugin<Interface>(default_class);
    plugin->configure(section);
    return plugin;
}

/** A configured object of a plug point as it stands in a configuration: a value that nobody
 * changes. Who works with it makes an object of their own, so that two users of one configuration
 * share nothing. */
template <class Interface>
class Prototype
{
 public:
    Prototype() = default;
    Prototype(std::shared_ptr<const Interface> object) : object_(std::move(object)) {}

    const Interface* operator->() const { return object_.get(); }

    /** A copy of its own, as configured. */
    std::unique_ptr<Interface> create() const
    {
        // A clone is of the class of its original, so this cast cannot fail.
        return std::unique_ptr<Interface>(dynamic_cast<Interface*>(object_->clone()));
    }

 private:
    std::shared_ptr<const Interface> object_;
};
}  // namespace taut
