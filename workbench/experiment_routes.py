"""The REST interface for experiments: lists designs, checks and runs them, and returns their rows, figures and trials."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query, Request
from fastapi.responses import Response
from pydantic import Field, TypeAdapter, ValidationError

from actr3d.processors import processors
from actr3d.values import to_json
from workbench.design_files import MOST, CheckRequest, Level, StartRequest, Workers, designs_of
from workbench.disconnects import while_connected
from workbench.experiment_command import ExperimentFacts, ExperimentRunError
from workbench.experiment_folder import PAGE, REPORT_FILES
from workbench.experiments import Experiments
from workbench.open_file import OpenFile, of_kinds
from workbench.protocol import problem_of
from workbench.recording_routes import Trusting
from workbench.routes import Id, code_json, json_response, made, sessions_of

router = APIRouter(prefix="/api")

MAX_ROWS = 500
"""Maximum number of rows in one answer."""
REPORT_POLICY = (
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; font-src data:; "
    "sandbox allow-downloads allow-same-origin; frame-ancestors 'self'"
)
"""The content security policy of a report: no scripts run, and nothing is loaded from elsewhere. The report keeps the page's origin, so
that its links can download files with the page's cookie."""

Column = Annotated[str, Query(min_length=1, max_length=200)]
WHERE: TypeAdapter[dict[str, Level]] = TypeAdapter(Annotated[dict[str, Level], Field(max_length=10)])


class ResumeRequest(Trusting):
    """How an experiment is continued."""

    workers: Workers | None = None
    """The number of processes that run trials; null for that of its last run, or one on each processor if that is not known."""


class TrialRequest(Trusting):
    """A trial to record."""

    number: Annotated[int, Field(ge=0, lt=2**53)]


def experiments_of(request: Request) -> Experiments:
    """Returns the experiments of the server that handles the request."""
    return request.app.state.experiments


# -- designs


@router.get("/designs")
def designs(request: Request) -> dict[str, Any]:
    """Lists the designs of the library and of the model files, without executing them.

    `processors` is how many experiments can use, `most` the greatest numbers with which an experiment can be started.
    """
    outlines = [asdict(outline) for outline in designs_of(sessions_of(request).folder)]
    return {"designs": outlines, "processors": processors(), "most": MOST}


@router.post("/designs/check")
async def check_design(request: Request, body: CheckRequest) -> Response:
    """Checks a design and returns its facts; with `trial`, also `seconds_a_trial`, which takes longer. 422 if it is not valid."""
    work = experiments_of(request).check(body)
    return json_response(to_json(await while_connected(work, request.receive)))


# -- experiments


@router.get("/experiments")
async def experiments(request: Request) -> Response:
    """Lists the newest experiments, newest first: state, progress, rate [1/s], remaining time [s]; `total` is the number of all."""
    total, listed = await experiments_of(request).listing()
    return json_response(to_json({"total": total, "experiments": listed}))


@router.post("/experiments", status_code=201)
async def start_experiment(request: Request, body: StartRequest) -> Response:
    """Starts an experiment, and returns its `id` once its design has been checked; 422 if it is not valid."""
    name = await experiments_of(request).start(body)
    return json_response(to_json(await experiments_of(request).one(name)), 201)


@router.get("/experiments/{experiment}")
async def experiment(request: Request, experiment: Id) -> Response:
    """Returns the state of an experiment, with its `facts`: factors, groups, description."""
    return json_response(to_json(await experiments_of(request).one(experiment)))


@router.post("/experiments/{experiment}/stop")
async def stop_experiment(request: Request, experiment: Id) -> dict[str, Any]:
    """Asks an experiment to end; its finished trials are kept, and it can be continued."""
    experiments_of(request).stop(experiment)
    return {"stopping": experiment}


@router.post("/experiments/{experiment}/resume")
async def resume_experiment(request: Request, experiment: Id, body: ResumeRequest | None = None) -> Response:
    """Continues an experiment; 409 if it is already running, 403 if this installation did not make it, unless `trust` is true."""
    said = body or ResumeRequest()
    await experiments_of(request).resume(experiment, said.workers, trust=said.trust)
    return json_response(to_json(await experiments_of(request).one(experiment)))


@router.post("/experiments/{experiment}/delete")
async def delete_experiment(request: Request, experiment: Id) -> dict[str, Any]:
    """Moves an experiment to the trash folder; 409 while it runs."""
    return {"trash": await experiments_of(request).delete(experiment)}


@router.get("/experiments/{experiment}/code")
def experiment_code(request: Request, experiment: Id) -> dict[str, Any]:
    """Returns the code that continuing an experiment, or opening one of its trials, runs; see `/recordings/{recording}/code`."""
    return code_json(**experiments_of(request).folder(experiment).code())


# -- what it has found


@router.get("/experiments/{experiment}/rows")
async def rows(
    request: Request,
    experiment: Id,
    first: Annotated[int, Query(ge=0, lt=2**53)] = 0,
    most: Annotated[int, Query(ge=1, le=MAX_ROWS)] = 100,
    where: Annotated[str, Query(max_length=2_000)] = "{}",
    sort: Column | None = None,
    down: bool = False,
    failed: bool = False,
) -> Response:
    """Returns rows of the table of trials: their `total`, and those from number `first` on.

    `where` is a JSON object with the values that the rows have, by column; `sort` a column; with `failed` only failed trials.
    """
    options = {"first": first, "most": most, "where": _where(where), "sort": sort, "down": down, "failed": failed}
    table = experiments_of(request).folder(experiment).table
    if table is None:
        return json_response(to_json({"total": 0, "first": first, "columns": [], "rows": []}))
    return OpenFile(await made(request, "trial rows", table, **options), "application/json")


@router.get("/experiments/{experiment}/means")
async def means(
    request: Request,
    experiment: Id,
    x: Column,
    measure: Column,
    by: Annotated[list[Column] | None, Query(max_length=4)] = None,
    over: Column | None = None,
    beside: Annotated[str | None, Query(min_length=1, max_length=160)] = None,
) -> Response:
    """Returns the mean of a measure for each combination of the values of columns, with its standard error over participants.

    `{points: [{at: [value of x and of each column of by], mean, error, participants, trials}]}`; of True and False, the share of True.
    The mean is that of the conditions there (combinations of levels of all factors, a group, and a number), each of which weighs the same.
    With `over`, the measure has a column for each number, `measure_1`, `measure_2`, ..., and `over` is the name of the column of numbers.

    `beside` is another experiment: then the means of both are over the conditions that both have and in which no trial failed. `{points,
    left_out: {conditions, trials}, beside: {points, left_out}, failed: {conditions, trials: [of one, of the other]}, apart}`; see
    `workbench.experiment_means.means`.
    """
    names = [experiment] if beside is None else [experiment, beside]
    facts: list[ExperimentFacts] = []
    tables: list[Path] = []
    for folder in map(experiments_of(request).folder, names):
        known, table = folder.facts, folder.table
        if table is None and beside is None:
            return json_response(to_json({"x": x, "by": by or [], "measure": measure, "unit": None, "columns": [], "points": []}))
        if known is None or table is None:
            raise ExperimentRunError("its factors are not known" if known is None else "none of its trials has finished")
        facts.append(known)
        tables.append(table)
    factors = {name for one in facts for name in one.factors}
    defaults = [
        {of["name"]: of["default"] for of in one.parameters if of.get("known", True) and of["name"] in factors - one.factors.keys()}
        for one in facts
    ]
    options = {"x": x, "by": by or [], "measure": measure, "over": over, "factors": sorted(factors), "defaults": defaults}
    return OpenFile(await made(request, "trial means", *tables, **options), "application/json")


@router.post("/experiments/{experiment}/trial")
async def record_trial(request: Request, experiment: Id, body: TrialRequest) -> dict[str, Any]:
    """Runs a trial again, records it, and returns the name of the recording; 403 as for `resume`."""
    work = experiments_of(request).record(experiment, body.number, trust=body.trust)
    return {"recording": await while_connected(work, request.receive)}


@router.post("/experiments/{experiment}/report")
async def make_report(request: Request, experiment: Id, body: Trusting | None = None) -> dict[str, Any]:
    """Makes the report of an experiment with `actr3d report`; 409 if that fails; 403 as for `resume`."""
    await while_connected(experiments_of(request).make_report(experiment, trust=body is not None and body.trust), request.receive)
    return {"report": experiment}


@router.get("/experiments/{experiment}/report/index.html", **of_kinds([REPORT_FILES[".html"]]))
def report(request: Request, experiment: Id) -> Response:
    """Returns the report of an experiment, an HTML page; no script in it runs."""
    response = _report_file(request, experiment, PAGE)
    response.headers["content-security-policy"] = REPORT_POLICY
    return response


@router.get("/experiments/{experiment}/report/{folder}/{file}", **of_kinds(REPORT_FILES.values()))
def report_file(request: Request, experiment: Id, folder: Literal["figures", "tables"], file: str) -> Response:
    """Returns a figure or table of the report, for a download."""
    return _report_file(request, experiment, f"{folder}/{file}", f"{experiment}-{file}")


def _report_file(request: Request, experiment: str, file: str, download: str | None = None) -> Response:
    path = experiments_of(request).folder(experiment).report_file(file)
    if path is None:
        return json_response(to_json({"error": "the report has no such file, or it has not been made yet"}), 404)
    return OpenFile(path.open("rb", buffering=0), REPORT_FILES[path.suffix], download)


def _where(text: str) -> dict[str, Any]:
    """Returns the conditions for rows.

    Raises:
        ExperimentRunError: If they are not a JSON object with plain values.
    """
    try:
        return dict(WHERE.validate_json(text))
    except ValidationError as error:
        problem = problem_of(error.errors(include_url=False, include_input=False)[0])
        raise ExperimentRunError(f"where: {problem}") from None
