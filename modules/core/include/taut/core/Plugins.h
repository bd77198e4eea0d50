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
}  // namespace taut
