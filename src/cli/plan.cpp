#include "cli/commands.hpp"
#include "cli/common.hpp"

#include <fmt/format.h>

namespace isostat::cli {

namespace {

/// The effective scene: its text is valid TOML, so that it can be saved and changed.
void add_settings(answers::Answer& out, const Scene& scene) {
    answers::say(out.text, "# {} with every default:\n", scene.file);
    std::string section;
    for (const Setting& setting : scene.settings) {
        out.json["settings"].push_back(
            {{"section", setting.section}, {"key", setting.key}, {"value", setting.value}, {"line", setting.line}});
        const bool new_step = setting.section == "[programme]" && setting.key == "do";
        if (setting.section != section || new_step) {
            section = setting.section;
            answers::say(out.text, "\n[{}]\n", section);
        }
        const std::string assignment = fmt::format("{} = {}", setting.key, setting.value);
        answers::say(out.text, "{:<44} # {}\n", assignment,
                     setting.line > 0 ? fmt::format("line {}", setting.line) : "default");
    }
}

} // namespace

int plan(const PlanArguments& arguments) {
    const Scene scene = read_scene(arguments.scene);
    if (!scene.start.empty()) {
        start_from_file(scene); // a start that a run would refuse is refused here
    }
    answers::Answer out;
    out.item("scene", scene.file);
    std::string used = "# used:\n", left_out = "# left out:\n";
    for (const PlanEntry& entry : make_plan(scene)) {
        out.json["plan"].push_back(
            {{"kind", entry.kind}, {"name", entry.name}, {"used", entry.used}, {"reason", entry.reason}});
        answers::say(entry.used ? used : left_out, "#   {:<7} {}: {}\n", entry.kind, entry.name, entry.reason);
    }
    out.text = used + "#\n" + left_out + "#\n" + (scene.programme.empty() ? "" : "# programme:\n");
    out.item("programme", Json::array());
    for (const ProgrammeStep& step : scene.programme) {
        out.json["programme"].push_back(describe(step));
        answers::say(out.text, "#   {}. {}\n", out.json["programme"].size(), describe(step));
    }
    out.text += scene.programme.empty() ? "" : "#\n";
    add_settings(out, scene);
    print(std::move(out), arguments.common);
    return done;
}

} // namespace isostat::cli
