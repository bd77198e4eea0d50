#include "taut/rawlog/RawlogWriter.h"

#include <mrpt/obs/CObservation.h>
#include <mrpt/serialization/archiveFrom_std_vector.h>

#include <cstdint>
#include <vector>

#include "GzOutput.h"
#include "taut/rawlog/toObservation.h"

namespace taut
{
struct RawlogWriter::Impl
{
    Impl(const std::string& path, const RawlogWriterConfig& c) : config(c), output(path) {}

    template <class Item>
    void write(const Item& item)
    {
        buffer.clear();
        auto archive = mrpt::serialization::archiveFrom(buffer);
        archive << *toObservation(item, config);
        output.write(buffer);
    }

    RawlogWriterConfig config;
    GzOutput output;
    std::vector<std::uint8_t> buffer;
};

RawlogWriter::RawlogWriter(const std::string& path, const RawlogWriterConfig& config)
    : impl_(std::make_unique<Impl>(path, config))
{
}
RawlogWriter::~RawlogWriter() = default;

void RawlogWriter::write(const ImuSample& sample)
{
    impl_->write(sample);
}

void RawlogWriter::write(const Scan& scan)
{
    impl_->write(scan);
}

void RawlogWriter::write(const PacketScan& scan)
{
    impl_->write(scan);
}

void RawlogWriter::close()
{
    impl_->output.close();
}
}  // namespace taut
