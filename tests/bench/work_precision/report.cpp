#include "bench/work_precision/report.hpp"

#include <isostat/preparation/preparation.hpp>

#include <fmt/format.h>

#include <fstream>
#include <stdexcept>

namespace work_precision {

std::vector<bench::Column> columns(const std::vector<std::string>& heads) {
    std::vector<bench::Column> all;
    for (const std::string& head : heads) {
        const bool error = head.starts_with('~');
        const std::string name = head.substr(error ? 1 : 0);
        all.push_back({name, name, "", error ? "{:.1e}" : "{:.3g}"});
    }
    return all;
}

void write(const Table& table, const Settings& settings) {
    table.write_csv(settings.folder / (table.name() + ".csv"));
    std::ofstream(settings.folder / "tables.md", std::ios::app)
        << fmt::format("**{}.** {}\n\n{}\n", table.name(), table.caption(), table.markdown());
    settings.program->show(table);
}

isostat::State prepared(int disks, std::uint64_t seed) {
    isostat::PreparationOptions options{.disks = disks, .seed = seed};
    isostat::PreparationReport report;
    auto state = isostat::prepare(options, report);
    if (!state.ok()) {
        throw std::runtime_error(fmt::format("{} disks, seed {}: {}", disks, seed, state.failure().message()));
    }
    return state.value();
}

void draw(const std::filesystem::path& folder, const std::string& name, const std::string& script) {
    bench::draw(folder, name,
                "set datafile separator ','\nset terminal svg size 760,520 font 'sans,13' background 'white'\nset "
                "grid\nset output '" +
                    name + ".svg'\n" + script);
}

} // namespace work_precision
