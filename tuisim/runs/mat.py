"""Access to the mat of a stored run."""

from __future__ import annotations

from tuisim.config.mat_cache import FieldFiles, open_field, prepare
from tuisim.config.mats import background
from tuisim.core.field import Field
from tuisim.errors import ConfigError, LogError
from tuisim.runs.run_folder import StoredRun


def open_mat(run: StoredRun) -> Field:
    """Return the mat of a run; prepares it again if it is no longer cached.

    Raises:
        LogError: the mat no longer exists, or its image has changed.
    """
    files = mat_files(run)
    try:
        return open_field(files)
    except ConfigError as error:
        raise _no_mat(run, error) from error


def mat_files(run: StoredRun) -> FieldFiles:
    """Return the files of the mat that `open_mat` opens; prepares them again if necessary.

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
        # The file names are derived from the contents of the image.
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
