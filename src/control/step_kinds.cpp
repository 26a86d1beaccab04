// SPDX-License-Identifier: Apache-2.0
#include "control/step_kinds.h"

#include "control/activities/compact.h"
#include "control/activities/dig/backfill.h"
#include "control/activities/dig/clear.h"
#include "control/activities/dig/dig.h"
#include "control/activities/dig/dig_area.h"
#include "control/activities/dig/grade.h"
#include "control/activities/dig/load_trucks.h"
#include "control/activities/drive_to.h"
#include "control/activities/dump.h"
#include "control/activities/go_to.h"
#include "control/activities/if_short.h"
#include "control/activities/repeat.h"
#include "control/activities/swing.h"
#include "control/activities/tip.h"
#include "control/activities/trajectory.h"
#include "control/activities/unhitch.h"
#include "control/activities/wait.h"
#include "control/activities/wait_for.h"
#include "control/activities/wait_load.h"

namespace navvy::control {

const scene::StepKinds& step_kinds() {
  // The one place that names every step. Messages list them in this order.
  static const scene::StepKinds kinds = {
      scene::step_kind<DriveTo>(),  scene::step_kind<Dig>(),        scene::step_kind<Swing>(),
      scene::step_kind<Dump>(),     scene::step_kind<Wait>(),       scene::step_kind<Tip>(),
      scene::step_kind<WaitFor>(),  scene::step_kind<Trajectory>(), scene::step_kind<GoTo>(),
      scene::step_kind<Unhitch>(),  scene::step_kind<DigArea>(),    scene::step_kind<Grade>(),
      scene::step_kind<Backfill>(), scene::step_kind<Repeat>(),     scene::step_kind<Compact>(),
      scene::step_kind<IfShort>(),  scene::step_kind<LoadTrucks>(), scene::step_kind<WaitLoad>(),
      scene::step_kind<Clear>(),
  };
  return kinds;
}

}  // namespace navvy::control
