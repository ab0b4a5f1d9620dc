// Uploaded examples.

#include "tests/unit/server/store_suite.h"

#include <algorithm>

namespace modelsynth::server {

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ExampleContract);

TEST_P(ExampleContract, WhatIsAddedIsFoundAndListed) {
    {
        const auto pin = value(artifacts().put("{}"));
        value(examples().add_example({"b", hard_text("name"), pin->digest()}, "", 10));
        value(examples().add_example({"a", "", pin->digest()}, "", 10));
    }
    between_steps();
    settle();
    const ExampleStore::Row found = value(examples().find_example("b", {}));
    EXPECT_EQ(found.id, "b");
    EXPECT_EQ(found.name, hard_text("name"));
    EXPECT_EQ(value(artifacts().load(found.digest)), "{}");
    const std::vector<ExampleStore::Row> rows = value(examples().list_examples({}));
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), [](const auto& row) {
        return row.id == "a" && row.name.empty();
    }));
    EXPECT_EQ(error_of(examples().find_example("c", {})), StoreErrorCode::kNotFound);
}

TEST_P(ExampleContract, OneOfThatIdStaysAsItIs) {
    const auto first = value(artifacts().put("{}"));
    const auto second = value(artifacts().put("[]"));
    value(examples().add_example({"a", "first", first->digest()}, "", 1));
    value(examples().add_example({"a", "second", second->digest()}, "", 1));
    value(examples().add_example({"a", "third", sha256_hex("never stored")}, "", 1));
    EXPECT_EQ(value(examples().find_example("a", {})).name, "first");
    EXPECT_EQ(value(examples().find_example("a", {})).digest, first->digest());
}

TEST_P(ExampleContract, NoMoreAreKeptThanTheCallerAllows) {
    const auto pin = value(artifacts().put("{}"));
    value(examples().add_example({"a", "", pin->digest()}, "", 2));
    value(examples().add_example({"b", "", pin->digest()}, "", 2));
    EXPECT_EQ(
        error_of(examples().add_example({"c", "", pin->digest()}, "", 2)),
        StoreErrorCode::kQueueFull
    );
    EXPECT_EQ(value(examples().list_examples({})).size(), 2U);
    value(examples().erase_example("a", {}));
    value(examples().add_example({"c", "", pin->digest()}, "", 2));
}

TEST_P(ExampleContract, AnExampleWhoseTextIsNotStoredIsAConflict) {
    for (const std::string& digest : {sha256_hex("never stored"), std::string("abc")}) {
        EXPECT_EQ(
            error_of(examples().add_example({"a", "", digest}, "", 10)), StoreErrorCode::kConflict
        );
    }
    EXPECT_TRUE(value(examples().list_examples({})).empty());
}

TEST_P(ExampleContract, AnErasedExampleIsForgottenWithItsText) {
    const std::string digest = sha256_hex("{}");
    {
        const auto pin = value(artifacts().put("{}"));
        value(examples().add_example({"a", "", digest}, "", 10));
        value(examples().add_example({"b", "", digest}, "", 10));
    }
    between_steps();
    value(examples().erase_example("a", {}));
    EXPECT_EQ(error_of(examples().find_example("a", {})), StoreErrorCode::kNotFound);
    EXPECT_EQ(error_of(examples().erase_example("a", {})), StoreErrorCode::kNotFound);
    settle();
    EXPECT_EQ(value(artifacts().load(digest)), "{}");  // the other one's too
    value(examples().erase_example("b", {}));
    EXPECT_TRUE(eventually([&] { return !artifacts().open(digest); }));
}

TEST_P(ExampleContract, AnExampleThatAnUnfinishedJobUsesIsNotErased) {
    const auto pin = value(artifacts().put("{}"));
    value(examples().add_example({"a", "", pin->digest()}, "", 10));
    NewJob job = new_job("job");
    job.example_id = "a";
    submit(job);
    EXPECT_EQ(error_of(examples().erase_example("a", {})), StoreErrorCode::kConflict);
    const auto claimed = claim();
    ASSERT_TRUE(claimed);
    EXPECT_EQ(error_of(examples().erase_example("a", {})), StoreErrorCode::kConflict);
    EXPECT_TRUE(examples().find_example("a", {}));
    value(jobs().finish(claimed->lease, failed()));
    value(examples().erase_example("a", {}));
    job = new_job("second");
    job.example_id = "b";
    submit(job);
    value(examples().add_example({"b", "", pin->digest()}, "", 10));
    EXPECT_EQ(error_of(examples().erase_example("b", {})), StoreErrorCode::kConflict);
    value(jobs().erase("second"));
    value(examples().erase_example("b", {}));
}

TEST_P(ExampleContract, AnExampleIsThereForThoseWhoGaveIt) {
    {
        const auto pin = value(artifacts().put("text"));
        value(examples().add_example({"a", "", pin->digest()}, "ann", 10));
        value(examples().add_example({"a", "", pin->digest()}, "bob", 10));
        value(examples().add_example({"b", "", pin->digest()}, "bob", 10));
    }
    between_steps();
    EXPECT_EQ(value(examples().list_examples({})).size(), 2U);
    EXPECT_EQ(value(examples().list_examples("ann")).size(), 1U);
    EXPECT_EQ(value(examples().list_examples("bob")).size(), 2U);
    EXPECT_TRUE(value(examples().list_examples("eve")).empty());
    EXPECT_TRUE(examples().find_example("a", "ann"));
    EXPECT_EQ(error_of(examples().find_example("b", "ann")), StoreErrorCode::kNotFound);
    EXPECT_EQ(error_of(examples().erase_example("b", "ann")), StoreErrorCode::kNotFound);

    value(examples().erase_example("a", "ann"));
    EXPECT_EQ(error_of(examples().find_example("a", "ann")), StoreErrorCode::kNotFound);
    EXPECT_TRUE(examples().find_example("a", "bob"));
    value(examples().erase_example("a", "bob"));
    EXPECT_EQ(error_of(examples().find_example("a", {})), StoreErrorCode::kNotFound);
}

TEST_P(ExampleContract, AJobOfAnotherOwnerIsNoReasonToKeepAnExample) {
    {
        const auto pin = value(artifacts().put("text"));
        value(examples().add_example({"a", "", pin->digest()}, "ann", 10));
        value(examples().add_example({"a", "", pin->digest()}, "bob", 10));
    }
    NewJob job = new_job("job");
    job.example_id = "a";
    job.owner = "bob";
    submit(job);
    between_steps();
    EXPECT_EQ(error_of(examples().erase_example("a", "bob")), StoreErrorCode::kConflict);
    EXPECT_EQ(error_of(examples().erase_example("a", {})), StoreErrorCode::kConflict);
    EXPECT_FALSE(error_of(examples().erase_example("a", "ann")));
}

}  // namespace modelsynth::server
