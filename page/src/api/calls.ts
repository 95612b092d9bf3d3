/** What the page asks of the server: one function for each path that it uses, typed by the contract. */
import createClient from "openapi-fetch";
import type { Language } from "../words/words.svelte";
import { detailOf, Refusal, SILENT } from "./refusal";
import type { paths } from "./schema";
import type * as Say from "./types";

const client = createClient<paths>({ baseUrl: "" });

/** As `openapi-fetch` has it: of tuples it only knows that they are arrays. */
type Loose<T> = T extends readonly (infer E)[]
	? Loose<E>[]
	: T extends object
		? { [K in keyof T]: Loose<T[K]> }
		: T;
interface Answered<T> {
	data?: T;
	error?: unknown;
	response: Response;
}

/** Told when the server says that nobody is signed in any more. */
export const gate = { closed: (): void => {} };
const CLOSED = 401;

/** What was answered; a no as `Refusal`, and silence too. */
async function got<T>(asked: Promise<Answered<Loose<T>>>): Promise<T> {
	let answered: Answered<Loose<T>>;
	try {
		answered = await asked;
	} catch {
		throw new Refusal(SILENT, { text: "" });
	}
	const { data, error, response } = answered;
	if (response.status === CLOSED) gate.closed();
	if (!response.ok) throw new Refusal(response.status, detailOf(error, response.status));
	return data as T;
}

export const about = () => got<Say.About>(client.GET("/api/v1/about"));
export const me = () => got<Say.Me>(client.GET("/api/v1/me"));
export const login = (body: Say.Login) => got<Say.Me>(client.POST("/api/v1/login", { body }));
export const logout = () => got<undefined>(client.POST("/api/v1/logout"));
export const changePassword = (now: string, another: string) =>
	got<undefined>(client.POST("/api/v1/me/password", { body: { now, new: another } }));
export const people = () => got<Say.People>(client.GET("/api/v1/people"));
export const setPerson = (body: Say.PersonAsked) => got<Say.People>(client.POST("/api/v1/people", { body }));
export const setAccount = (name: string, body: Say.AccountAsked) =>
	got<Say.People>(client.POST("/api/v1/people/{name}/account", { params: { path: { name } }, body }));
export const rules = () => got<Say.Rules>(client.GET("/api/v1/settings"));
export const setRules = (body: Say.RulesAsked) => got<Say.Rules>(client.POST("/api/v1/settings", { body }));
export const benchInfo = () => got<Say.BenchInfo>(client.GET("/api/v1/bench"));
export const play = () => got<Say.Play>(client.POST("/api/v1/play"));
export const arms = () => got<Say.Arms>(client.GET("/api/v1/arms"));
export const arm = (sha256: string) =>
	got<Say.ArmWhole>(client.GET("/api/v1/arms/{sha256}", { params: { path: { sha256 } } }));
export const files = (kind?: Say.FileKind) =>
	got<Say.Files>(client.GET("/api/v1/files", { params: { query: kind === undefined ? {} : { kind } } }));
export const ports = () => got<Say.Ports>(client.GET("/api/v1/sources/ports"));
export const guess = (source: string, seconds: number) =>
	got<Say.Guessed>(client.POST("/api/v1/sources/guess", { body: { source, seconds } }));
export const activities = () => got<Say.Activities>(client.GET("/api/v1/activities"));
export const activity = (name: string) =>
	got<Say.Activity>(client.GET("/api/v1/activities/{name}", { params: { path: { name } } }));
export const begin = (body: Say.Begin) => got<Say.Activity>(client.POST("/api/v1/activities", { body }));
export const say = (name: string, body: Say.Do) =>
	got<Say.Activity>(client.POST("/api/v1/activities/{name}/do", { params: { path: { name } }, body }));
export const jobs = () => got<Say.Jobs>(client.GET("/api/v1/jobs"));
export const beginJob = (body: Say.BeginJob) => got<Say.Job>(client.POST("/api/v1/jobs", { body }));
export const cancelJob = (name: string) =>
	got<Say.Job>(client.POST("/api/v1/jobs/{name}/cancel", { params: { path: { name } } }));
export const result = (sha256: string, language: Language) =>
	got<Say.ResultWhole>(
		client.GET("/api/v1/results/{sha256}", { params: { path: { sha256 }, query: { language } } }),
	);

export const makePlan = (body: Say.PlanAsked) => got<Say.PlanInfo>(client.POST("/api/v1/plans", { body }));
export const plan = (sha256: string, arm: string) =>
	got<Say.PlanInfo>(client.GET("/api/v1/plans/{sha256}", { params: { path: { sha256 }, query: { arm } } }));
export const planned = (sha256: string) =>
	got<Say.PlanOutcome>(client.GET("/api/v1/plans/{sha256}/outcome", { params: { path: { sha256 } } }));

export const look = (body: Say.StudyAsked) => got<Say.Looked>(client.POST("/api/v1/tables/look", { body }));
export const makeStudy = (body: Say.StudyAsked) =>
	got<Say.StudyMade>(client.POST("/api/v1/studies", { body }));

export const playGuided = () => got<Say.PlayGuided>(client.POST("/api/v1/tests/play"));
export const profiles = () => got<Say.Profiles>(client.GET("/api/v1/tests/profiles"));
export const wants = (profile: string, arm: string) =>
	got<Say.ProfileWants>(client.GET("/api/v1/tests/wants", { params: { query: { profile, arm } } }));
export const makeTest = (body: Say.TestAsked) =>
	got<Say.TestPlanMade>(client.POST("/api/v1/tests", { body }));

export const equipment = () => got<Say.AllEquipment>(client.GET("/api/v1/records/equipment"));
export const register = (body: Say.RegisterAsked) =>
	got<Say.EquipmentWhole>(client.POST("/api/v1/records/equipment", { body }));
export const equipmentOf = (name: string) =>
	got<Say.EquipmentWhole>(client.GET("/api/v1/records/equipment/{name}", { params: { path: { name } } }));
export const trend = (name: string, figure: string, state: string | null, artefact: string | null) =>
	got<Say.Trend>(
		client.GET("/api/v1/records/equipment/{name}/trend", {
			params: { path: { name }, query: { figure, state, artefact } },
		}),
	);
export const advice = (name: string, figure: string | null) =>
	got<Say.AllAdvice>(
		client.GET("/api/v1/records/equipment/{name}/advice", { params: { path: { name }, query: { figure } } }),
	);
export const impact = (name: string) =>
	got<Say.Impact>(client.GET("/api/v1/records/equipment/{name}/impact", { params: { path: { name } } }));
export const happened = (name: string, body: Say.EventAsked) =>
	got<Say.Entries>(
		client.POST("/api/v1/records/equipment/{name}/events", { params: { path: { name } }, body }),
	);
export const fileInRecord = (body: Say.AddAsked) =>
	got<Say.Added>(client.POST("/api/v1/records/add", { body }));
export const certify = (body: Say.CertifyAsked) =>
	got<Say.Entries>(client.POST("/api/v1/records/certify", { body }));
export const withdrawFiled = (subject: string, reason: string) =>
	got<Say.Entries>(client.POST("/api/v1/records/withdraw", { body: { subject, reason } }));
export const verifyRecord = () => got<Say.Verified>(client.GET("/api/v1/records/verify"));
export const certificates = () => got<Say.Certificates>(client.GET("/api/v1/records/certificates"));
export const issue = (body: Say.IssueAsked) =>
	got<Say.IssuedNow>(client.POST("/api/v1/records/issue", { body }));
export const proposals = () => got<Say.Proposals>(client.GET("/api/v1/records/proposals"));
export const propose = (body: Say.IssueAsked) =>
	got<Say.Proposal>(client.POST("/api/v1/records/proposals", { body }));
export const approve = (name: string) =>
	got<Say.Proposal>(client.POST("/api/v1/records/proposals/{name}/approve", { params: { path: { name } } }));
export const decline = (name: string, reason: string) =>
	got<Say.Proposal>(
		client.POST("/api/v1/records/proposals/{name}/decline", { params: { path: { name } }, body: { reason } }),
	);
export const compare = (body: Say.CompareAsked) =>
	got<Say.Compared>(client.POST("/api/v1/compare", { body }));

export const checked = (sha256: string) =>
	got<Say.CheckOutcome>(client.GET("/api/v1/checks/{sha256}", { params: { path: { sha256 } } }));
export const verified = (sha256: string) =>
	got<Say.VerificationOutcome>(
		client.GET("/api/v1/verifications/{sha256}", { params: { path: { sha256 } } }),
	);

/** A file by its bytes; its name goes beside them. */
export const bring = (file: Blob, name: string) =>
	got<Say.FileInfo>(
		client.POST("/api/v1/files", {
			params: { query: { name } },
			body: "",
			bodySerializer: () => file,
			headers: { "Content-Type": "application/octet-stream" },
		}),
	);

/** To be saved, never shown. */
export const contentUrl = (sha256: string) => `/api/v1/files/${sha256}/content`;
/** Where somebody signs in elsewhere, and from where they come back. */
export const PROVIDER = "/api/v1/provider/begin";
/** To be shown in a frame of its own. */
export const reportUrl = (sha256: string) => `/api/v1/files/${sha256}/report`;
