"""What a report says, in numbers and statements: each part beside what makes it; no markup, no language."""
