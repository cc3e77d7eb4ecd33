// SPDX-License-Identifier: Apache-2.0
#include "view/page.h"

#include "base/printable.h"
#include "report/page.h"
#include "scene_io/json_text.h"
#include "scene_io/load_scene.h"
#include "view/page_parts.h"

namespace nacre {

ServedPage MakeViewPage(const std::string& title, const std::string& generator,
                        const std::string& tone, double exposure) {
  // The schema holds the parameters of all models, with ranges, defaults and meanings.
  const std::string data = ScriptJson({{"tone", tone},
                                       {"exposure", exposure},
                                       {"generator", generator},
                                       {"schema", Json::parse(SceneSchema())}});
  const std::string safe_title = EscapeHtml(Printable(title));
  ServedPage page;
  page.html = FillPage(
      ViewTemplate(),
      {{"title", safe_title}, {"style", ViewStyle()}, {"script", ViewScript()}, {"data", data}});
  page.style_hashes = "'" + PolicySource(ViewStyleSha256()) + "'";
  page.script_hashes = "'" + PolicySource(ViewScriptSha256()) + "'";
  return page;
}

}  // namespace nacre
