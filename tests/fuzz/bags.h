#pragma once

#include "../../modules/importing/src/bag/BagReader.h"
#include "imported.h"

namespace taut::fuzz
{
/** Reads all messages of a bag, of whatever type. */
inline void readMessages(bag::BagReader& reader)
{
    std::vector<std::string> names;
    for (const bag::BagTopic& topic : reader.topics()) names.push_back(topic.name);
    reader.choose(names);
    unsigned sum = 0;  // every byte is touched
    while (const auto message = reader.next())
        for (std::size_t i = 0; i < message->data.size; i++) sum += message->data.data[i];
    static volatile unsigned keep;
    keep = sum;
}

/** The container alone, then what is in it. */
inline void readBag(const char* name, const Input& content)
{
    static const Folder folder;
    const std::string path = folder.write(name, content);
    readOrRefuse([&] { readMessages(*bag::openBagReader(path, [](const Warning&) {})); });
    readOrRefuse([&] { importAll(path); });
}
}  // namespace taut::fuzz
