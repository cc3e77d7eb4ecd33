// SPDX-License-Identifier: Apache-2.0
// cli/cmd_view.cc: nacre view [SCENE | IMAGES...]
#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/path.h"
#include "base/printable.h"
#include "base/version.h"
#include "cli/commands.h"
#include "cli/help_text.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/render_options.h"
#include "cli/report_sections.h"
#include "cli/usage_error.h"
#include "report/child_process.h"
#include "scene_io/kept_files.h"
#include "view/edits.h"
#include "view/page.h"
#include "view/private_file.h"
#include "view/server.h"
#include "view/token.h"
#include "view/worker.h"

namespace nacre {
namespace {

struct ViewArguments {
  std::vector<std::string> inputs;
  std::optional<std::string> variant;
  bool no_open = false;
  ServerOptions server;
  RenderOptions options;
};

// How long the program may take to end after a signal.
constexpr std::chrono::milliseconds kEndsWithin(800);

// A page, in a file that only the user can read, that redirects the browser to the address. The
// address contains the token, and all users of the machine can see the arguments of programs.
class RedirectFile {
 public:
  explicit RedirectFile(const std::string& url) {
    std::string folder = SessionFolder();
    if (folder.empty()) folder = StateFolder();
    if (folder.empty()) return;
    path_ = fmt::format("{}/nacre-view-{}.html", folder, getpid());
    const std::string html = fmt::format(
        "<!DOCTYPE html>\n<meta charset=\"utf-8\">\n<meta name=\"referrer\" "
        "content=\"no-referrer\">\n"
        "<meta http-equiv=\"refresh\" content=\"0; url={0}\">\n<title>nacre view</title>\n"
        "<a href=\"{0}\">nacre view</a>\n",
        url);
    if (!WritePrivateFile(path_, html)) path_.clear();
  }
  ~RedirectFile() {
    if (!path_.empty()) unlink(path_.c_str());
  }
  RedirectFile(const RedirectFile&) = delete;
  RedirectFile& operator=(const RedirectFile&) = delete;

  // The URL of the file (RFC 8089); empty if there was no folder to create it in.
  std::string url() const {
    std::string text = path_.empty() ? "" : "file://";
    for (const char c : path_) {
      const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                         std::string_view("/-._~").find(c) != std::string_view::npos;
      text += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return text;
  }

 private:
  std::string path_;
};

// Opens the user's browser if there is a display. Failures are ignored, as the address has been
// printed.
void OpenBrowser(const std::string& file_url) {
  std::optional<std::string> program = FindProgram("xdg-open");
  if (!program) {
    PrintError("note: there is no xdg-open to open a browser with; open the address yourself\n");
    return;
  }
  if (file_url.empty()) {
    PrintError(
        "note: there is no folder of the user's own for a page that leads the browser to the "
        "address (XDG_RUNTIME_DIR, XDG_STATE_HOME); open it yourself\n");
    return;
  }
  std::string argument = file_url;
  char* const arguments[] = {program->data(), argument.data(), nullptr};
  // Starts it silently, since stdout has the address, and in a session of its own, which Ctrl-C
  // does not reach.
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_t actions;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int failed =
      posix_spawn(&child, program->c_str(), &actions, &attributes, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (failed != 0) {
    PrintError("note: {} does not start; open the address yourself\n", *program);
    return;
  }
  std::thread([child] { waitpid(child, nullptr, 0); }).detach();
}

LoadOptions MakeViewLoadOptions(const RenderOptions& options) {
  // options.spp is for the resting picture and goes to the worker instead of into the scene.
  RenderOptions of_scene = options;
  of_scene.spp.reset();
  LoadOptions load = MakeLoadOptions(of_scene);
  load.on_progress = [](double) { ThrowIfStopped(); };
  return load;
}

// How pictures open in a page that is made of them. HDR-FLIP takes seconds, so it is left out.
PerceptualArguments ShownAs(const DisplaySettings& display) {
  PerceptualArguments shown;
  shown.metrics = {"ssim", "flip"};
  shown.display = display;
  return shown;
}

// The report's page for pictures; the first is compared with the second.
std::string PicturesPage(const std::vector<ReportPicture>& pictures,
                         const PerceptualArguments& shown) {
  constexpr size_t kMaxSampleBytes = size_t{256} << 20;
  Page page;
  const Json section = PictureSection(pictures, pictures.size() > 1 ? 1 : 0,
                                      MakePerceptualOptions(shown), kMaxSampleBytes, &page);
  std::string title = pictures[0].name;
  if (pictures.size() > 1) title += " against " + pictures[1].name;
  return ReportHtml(title, Json::array({section}), shown, page);
}

// Prints where the server is, and opens it in the browser. The returned file must live as long as
// the server.
std::unique_ptr<RedirectFile> Announce(const ViewArguments& arguments, const Server& server) {
  const std::string& address = arguments.server.address;
  const bool is_loopback = address == "::1" || address.starts_with("127.");
  if (!is_loopback) {
    PrintError(
        "warning: {} can be reached from other machines, and what is sent there is not "
        "encrypted: put a proxy with TLS ahead of it, and name it by --origin https://HOST\n",
        address);
  }
  PrintOut("{}\n", server.url());
  FinishOutput();
  if (!arguments.options.quiet) {
    PrintError("nacre view: open the address above; Ctrl-C ends it\n");
  }
  std::unique_ptr<RedirectFile> redirect;
  const bool has_display =
      std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
  if (!arguments.no_open && has_display) {
    redirect = std::make_unique<RedirectFile>(server.url());
    OpenBrowser(redirect->url());
  }
  return redirect;
}

// Serves until a stop signal, which is the regular end.
void RunServer(Server* server, int* exit_code) {
  server->Run([] { return StopExitCode() != 0; });
  *exit_code = StopExitCode();
}

void NoteOtherName(const std::string& origin) {
  PrintError(
      "note: a browser with the right token calls this server {}, which is not its name, and was "
      "refused; if that is a tunnel or proxy of yours, start nacre view with --origin {}\n",
      origin, origin);
}

ServerOptions MakeServerOptions(const ViewArguments& arguments) {
  ServerOptions options = arguments.server;
  while (options.origin.ends_with('/')) options.origin.pop_back();
  // A port that the user chose keeps its token, so that open pages can reconnect.
  options.token = options.port != 0 ? KeptToken(options.port) : MakeToken();
  return options;
}

// Shows images in the report's page, without a scene. When files change, the page is made again.
void RunImages(const ViewArguments& arguments, const CLI::App& command, int* exit_code) {
  const RenderOptions& options = arguments.options;
  std::set<std::string> of_scenes = {"--size", "--spp", "--set", "--allow-paths", "--variant"};
  for (const SettingKey& key : SettingKeys()) {
    // As --target, these two are accepted: they do not change what is seen.
    if (key.name != "intersector" && key.name != "tile_size") of_scenes.insert(OptionOf(key));
  }
  RefuseOptions(
      command, [&](const CLI::Option& option) { return !of_scenes.contains(option.get_name()); },
      "images", "it is for scenes, which are rendered");
  const PerceptualArguments shown = ShownAs(options.display);
  const auto keys = [&] {
    std::vector<std::string> all;
    for (const std::string& path : arguments.inputs) all.push_back(KeyOfFile(path));
    return all;
  };
  const auto make = [&]() -> ServedPage {
    std::vector<ReportPicture> pictures;
    for (const std::string& path : arguments.inputs) pictures.push_back(ReadPicture(path, ""));
    return MakeImagesPage(PicturesPage(pictures, shown));
  };
  std::vector<std::string> before = keys();
  Server* running = nullptr;
  std::string banner;
  int ticks = 0;
  const auto tick = [&] {
    constexpr int kTicksBetweenLooks = 6;
    if (++ticks % kTicksBetweenLooks != 0) return;
    std::vector<std::string> now = keys();
    if (now == before) return;
    before = std::move(now);
    try {
      running->Serve(make());
      banner.clear();
      running->Say(0, Json{{"reload", true}}.dump());
    } catch (const std::exception& error) {  // the previous pictures stay
      banner = PrintableLines(error.what());
      running->Say(0, Json{{"banner", banner}}.dump());
    }
  };
  Server server(MakeServerOptions(arguments), make(),
                {[&](ClientId id) {
                   running->Say(id, Json{{"banner", banner}}.dump());
                 },
                 [](ClientId) {},
                 [](ClientId, std::string_view) {
                   throw Error(ExitCode::kUsage, "", "images have nothing to ask for");
                 },
                 [](double, size_t) {}, tick, NoteOtherName});
  running = &server;
  const auto redirect = Announce(arguments, server);
  RunServer(&server, exit_code);
}

bool IsScene(const std::string& path) {
  RefuseOtherModels(path);
  return IsModelFile(path) || HasExtension(path, ".json");
}

// The file for edits that outlive the server. Prints a line about edits that it already holds.
std::unique_ptr<EditsFile> OpenEdits(const std::string& scene, bool quiet) {
  std::string why_not;
  std::unique_ptr<EditsFile> edits = EditsFile::Open(scene, &why_not);
  if (quiet) return edits;
  if (!edits) {
    PrintError("note: edits are not kept for the case that the server ends: {}\n", why_not);
  } else if (!edits->offered().empty()) {
    const size_t count = edits->offered().size();
    PrintError("note: {} edit{} of {:%Y-%m-%d %H:%M} {} not saved; the page offers {}\n", count,
               count == 1 ? "" : "s", fmt::localtime(edits->offered_time()),
               count == 1 ? "was" : "were", count == 1 ? "it" : "them");
  }
  return edits;
}

void RunView(const ViewArguments& arguments, const CLI::App& command, int* exit_code) {
  const std::jthread stops = StopInTime(kEndsWithin);
  const RenderOptions& options = arguments.options;
  ApplyTarget(options.target);
  const std::vector<std::string>& inputs = arguments.inputs;
  if (!inputs.empty() && std::ranges::none_of(inputs, IsScene)) {
    return RunImages(arguments, command, exit_code);
  }
  if (inputs.size() > 1) {
    throw Error(ExitCode::kUsage, "nacre view", "shows one scene, or images",
                "nacre report renders several scenes into one page");
  }
  const std::string scene = inputs.empty() ? "" : inputs[0];
  LoadOptions load = MakeViewLoadOptions(options);
  load.variant = arguments.variant;
  const auto open = [&]() -> std::unique_ptr<ViewDocument> {
    if (scene.empty()) return std::make_unique<ViewDocument>(load);
    return std::make_unique<ViewDocument>(scene, load);
  };
  WorkerOptions work;
  work.samples = options.spp.value_or(0);
  work.settings = MakeRenderSettings(options);
  work.display = options.display;
  work.file = scene;
  const std::string generator = fmt::format("nacre {} ({})", kVersion, kCommit);
  work.generator = generator;
  work.make_report = [](const Image& a, const Image& b, const DisplaySettings& display) {
    return PicturesPage({{"B", b, {}}, {"A", a, {}}}, ShownAs(display));
  };
  if (!options.size.empty()) work.given = {"--size", options.size};
  if (arguments.variant) {
    work.given.insert(work.given.end(), {"--variant", *arguments.variant});
  }
  for (const std::string& set : options.sets) {
    work.given.emplace_back("--set");
    work.given.push_back(set);
  }
  Worker worker(open, work);

  const std::string title = scene.empty() ? "nacre view" : fmt::format("{} - nacre view", scene);
  Server server(MakeServerOptions(arguments), MakeViewPage(title, generator, options.display),
                {[&](ClientId id) { worker.Opened(id); }, [&](ClientId id) { worker.Closed(id); },
                 [&](ClientId id, std::string_view text) { worker.Receive(id, text); },
                 [&](double ms, size_t bytes) { worker.Ready(ms, bytes); }, [] {}, NoteOtherName});
  std::unique_ptr<EditsFile> edits = OpenEdits(scene, options.quiet);
  const auto redirect = Announce(arguments, server);
  worker.Start({[&](SharedBytes frame) { server.Show(std::move(frame)); },
                [&](ClientId id, std::string text) { server.Say(id, std::move(text)); },
                [&](ClientId id, SharedBytes bytes) { server.Send(id, std::move(bytes)); }},
               std::move(edits));
  RunServer(&server, exit_code);
  worker.Stop();  // before the server is destroyed, which the worker sends to
}

}  // namespace

void AddViewCommand(CLI::App* app, int* exit_code) {
  CLI::App* command = app->add_subcommand(
      "view", "Show a scene in the browser, with a slider for everything that can be changed");
  const auto arguments = std::make_shared<ViewArguments>();
  command->add_option(
      "INPUT", arguments->inputs,
      "Scene file (.json) or model (.gltf, .glb, .obj, .ply), or images to compare; "
      "without one, Phong and physically based spheres beside a grid");
  command
      ->add_option("--port", arguments->server.port,
                   "Port to listen on; 0: one that is free. With a port the address stays the same "
                   "from one start to the next, and open pages find the server again")
      ->check(WholeInRange(0, 65535))
      ->capture_default_str();
  command->add_flag("--no-open", arguments->no_open, "Open no browser, only print the address");
  RenderOptions* const o = &arguments->options;
  AddDisplayOptions(command, &o->display,
                    fmt::format("Tone operator that the page opens with: {}",
                                fmt::join(ToneOperatorNames(), ", ")),
                    "Exposure in stops that the page opens with");
  command->add_option("--size", o->size, "Width and height in pixels")->type_name("WxH");
  command
      ->add_option("--spp", o->spp,
                   "Samples per pixel once nothing moves; the scene's if not given")
      ->check(WholeInRange(1, 65536));
  AddViewSettingOptions(command, o);
  command->add_option("--set", o->sets, "Change a value of the scene, as render does; repeatable")
      ->type_name("/POINTER=JSON")
      ->allow_extra_args(false);
  command
      ->add_option("--variant", arguments->variant,
                   "Show a glTF model in this variant of its materials; `nacre info` lists them")
      ->type_name("NAME");
  command
      ->add_option(
          "--listen", arguments->server.address,
          "Address to listen on. Any but this machine's own (127.0.0.1, ::1) needs a proxy "
          "with TLS ahead of it")
      ->type_name("ADDRESS")
      ->capture_default_str();
  command
      ->add_option("--origin", arguments->server.origin,
                   "How browsers call the proxy ahead, e.g. https://nacre.example.org")
      ->type_name("URL");
  command->add_flag("--quiet", o->quiet, "Print nothing but the address and errors");
  AddMachineOptions(command, o);
  MoveBehindHelpAll(command, {"--listen", "--origin", "--quiet"});
  command->footer(
      "Examples:\n"
      "  nacre view\n"
      "  nacre view scenes/material_grid.json --spp 64\n"
      "  nacre view a.exr b.exr\n"
      "  nacre view scene.json --port 8080 --no-open");
  command->callback([arguments, command, exit_code] { RunView(*arguments, *command, exit_code); });
}

}  // namespace nacre
