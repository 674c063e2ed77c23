"""Operators that run a conversion: to its end at once, or beside the user's work, with progress and cancel."""

import time

import bpy

from .child import VoxError

POLL = 0.1  # seconds between two looks at vox
MOST_WARNINGS = 5  # that are shown; each frame may have its own


class Run:
    """The conversion that runs, for the panel; `now` is None if there is none."""

    now = None

    def __init__(self, name):
        self.name = name
        self.is_cancelled = False
        self.fraction = 0
        self.stage = ""

    def text(self):
        return f"{self.name}: {self.fraction:.0%} {self.stage}"


class RunsConversion:
    """Base of the operators. Theirs are `begin`, which makes the Conversion, and `end`, which shows its result."""

    def execute(self, context):
        return self.run(context)

    def invoke(self, context, event):
        return self.run(context) if bpy.app.background else self.start(context)

    def run(self, context):
        """Converts while Blender waits."""
        try:
            conversion = self.begin(context)
            for _ in conversion.steps():
                time.sleep(POLL / 10)
            return self._finish(context, conversion)
        except (VoxError, OSError) as wrong:
            return self._fail(wrong)

    def start(self, context):
        """Converts while the user goes on."""
        try:
            self._conversion = self.begin(context)
        except (VoxError, OSError) as wrong:
            return self._fail(wrong)
        self._steps = self._conversion.steps()
        Run.now = Run(self._conversion.name)
        self._timer = context.window_manager.event_timer_add(POLL, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC" or Run.now.is_cancelled:
            self.cancel(context)
            self.report({"INFO"}, "Cancelled")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        try:
            Run.now.fraction, Run.now.stage = next(self._steps)
        except StopIteration:
            self._stop(context)
            try:
                return self._finish(context, self._conversion)
            except (VoxError, OSError) as wrong:
                return self._fail(wrong)
        except (VoxError, OSError) as wrong:
            self._stop(context)
            return self._fail(wrong)
        except Exception:
            self._stop(context)
            raise
        self._show(context)
        return {"PASS_THROUGH"}

    def cancel(self, context):
        """Blender calls this, too, when it ends or loads another file."""
        self._steps.close()
        self._stop(context)

    def _show(self, context):
        context.window_manager.vox_progress = 100 * Run.now.fraction
        context.workspace.status_text_set(f"{Run.now.text()}    Esc: cancel")
        _redraw(context)

    def _stop(self, context):
        Run.now = None
        context.window_manager.event_timer_remove(self._timer)
        if context.workspace:
            context.workspace.status_text_set(None)
        _redraw(context)

    def _finish(self, context, conversion):
        self.end(context, conversion)
        for warning in conversion.warnings[:MOST_WARNINGS]:
            self.report({"WARNING"}, warning)
        if more := len(conversion.warnings[MOST_WARNINGS:]):
            self.report({"WARNING"}, f"and {more} more warnings")
        self.report({"INFO"}, f"{conversion.path}: written")
        return {"FINISHED"}

    def _fail(self, wrong):
        text = f"{wrong.filename}: {wrong.strerror}" if isinstance(wrong, OSError) else str(wrong)
        self.report({"ERROR"}, text)
        return {"CANCELLED"}


def _redraw(context):
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


class CancelRun(bpy.types.Operator):
    """Stop the conversion that runs; no file changes"""

    bl_idname = "object.vox_cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, context):
        return Run.now is not None

    def execute(self, context):
        Run.now.is_cancelled = True
        return {"FINISHED"}
