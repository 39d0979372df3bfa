/** Draws the report of the page's kind. */
import {jp} from "report/core.js";
import "report/plan.js";
import "report/diagnosis.js";
import "report/compare.js";
import "report/batch.js";

jp.start(({plan: jp.draw_plan, diagnosis: jp.draw_diagnosis, compare: jp.draw_compare, front: jp.draw_front, batch: jp.draw_batch})[document.documentElement.dataset.kind]);
