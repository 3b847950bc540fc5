"""The mat that a stored run was made on, found again."""

from __future__ import annotations

from tuisim.config.assets import background
from tuisim.config.mat_cache import FieldFiles, open_field, prepare
from tuisim.core.field import Field
from tuisim.errors import ConfigError, LogError
from tuisim.runs.run_folder import StoredRun


def open_mat(run: StoredRun) -> Field:
    """Return the mat of a run, prepared again if the cache has dropped it.

    Raises:
        LogError: there is no such mat any more, or its picture is another one now.
    """
    files = mat_files(run)
    try:
        return open_field(files)
    except ConfigError as error:
        raise _no_mat(run, error) from error


def mat_files(run: StoredRun) -> FieldFiles:
    """Return the files of what `open_mat` opens; they are there now, and are prepared again if need be.

    Raises:
        LogError: as `open_mat`.
    """
    try:
        made_on = None if run.field is None else FieldFiles.from_plain(run.field)
        if made_on is not None and _all_there(made_on):
            return made_on
        name = run.spec.world.background
        image = background(name).image
        diameters = {sensor.diameter_mm for sensor in run.spec.robot.color_sensors}
        found = prepare(image, diameters, fit=run.spec.world.background_fit)
        # The files are called after the content of the picture.
        if made_on is not None and found.pixels.name != made_on.pixels.name:
            raise LogError(f"the mat {name} is not the one of the run any more", file=str(image))
    except ConfigError as error:
        raise _no_mat(run, error) from error
    except (KeyError, TypeError, ValueError) as error:
        raise LogError(f"the mat of the run is not named: {error}", file=str(run.folder)) from error
    return found


def _no_mat(run: StoredRun, error: ConfigError) -> LogError:
    return LogError(f"the mat of the run: {error.message}", error.hint, file=str(run.folder))


def _all_there(files: FieldFiles) -> bool:
    return all(path.is_file() for path in (files.pixels, *(path for _, path in files.sums)))
